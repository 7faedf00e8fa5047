#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "renderer/gl/context.h"
#include "renderer/metrics/shared/metric.h"
#include "renderer/params/described.h"
#include "renderer/params/field.h"

namespace sheer::catalog {

// The available choices, as listed by `GET /methods`, similar calls, and `sheer methods --json`. The descriptions say
// what each member means.

/// Of a target in each of the formats.
struct BytesPerPixel {
    double rgba8 = 0, rgba16f = 0, rgba32f = 0;
};

struct Method {
    std::string id, name, kind, summary, paper, good_at, bad_at, memory, passes, needs;
    std::optional<BytesPerPixel> bytes_per_px;
    bool needs_sorting = true;
    std::vector<Field> parameters;
    std::string no_metrics_reason;
};

struct Scene {
    std::string id, name, summary, source;
    std::vector<Field> parameters;
};

struct MetricColumn {
    std::string head;
    std::optional<Better> better;
    int digits = 3;
    std::string note;
};

struct MetricField {
    std::string name, full_name;
    sheer::MetricField::Kind kind = sheer::MetricField::Kind::number;
    std::string unit, range, summary;
    bool null_is_identical = false;
    std::optional<MetricColumn> column;
};

struct Metric {
    std::string id, name, summary, source, formula, good_for, picture;
    std::vector<MetricField> fields;
};

struct Suite {
    std::string id, title, source, device;
    nlohmann::json spec;
    std::size_t published_count = 0, trend_count = 0;
};

/// A file to which a ready-made spec refers.
struct ExampleFile {
    std::string pointer, name, url;
};

struct Example {
    std::string id, teaches;
    std::optional<std::string> picture;
    nlohmann::json spec;
    std::vector<ExampleFile> files;
};

struct Workaround {
    std::string name, paragraph;
};

struct ListedDevice : gl::DeviceInfo {
    std::optional<std::string> error;
    std::vector<Workaround> workarounds;
};

std::vector<Method> methods();
std::vector<Scene> scenes();
std::vector<Metric> metrics();
std::vector<Suite> suites();

/// The name of the schema of a spec as it may be posted.
inline constexpr const char* posted_spec_name = "Spec";
nlohmann::json posted_spec_reference(SchemaBook& book);

}  // namespace sheer::catalog

namespace sheer {

template <>
struct Words<Better> {
    static constexpr std::pair<Better, const char*> all[] = {
        {Better::lower, "lower"}, {Better::higher, "higher"}, {Better::nearer_zero, "nearer zero"}};
};
template <>
struct Words<MetricField::Kind> {
    using enum MetricField::Kind;
    static constexpr std::pair<MetricField::Kind, const char*> all[] = {
        {number, "number"}, {count, "count"}, {pixel, "pixel"}, {text, "text"}};
};

template <>
const Description<catalog::Method>& description_of();
template <>
const Description<catalog::Scene>& description_of();
template <>
const Description<catalog::MetricColumn>& description_of();
template <>
const Description<catalog::MetricField>& description_of();
template <>
const Description<catalog::Metric>& description_of();
template <>
const Description<catalog::Suite>& description_of();
template <>
const Description<catalog::ExampleFile>& description_of();
template <>
const Description<catalog::Example>& description_of();
template <>
const Description<catalog::Workaround>& description_of();
template <>
const Description<catalog::ListedDevice>& description_of();

}  // namespace sheer
