#pragma once
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "renderer/results/report.h"

namespace sheer::http::answer {

// The service's answers other than reports and catalogs, as types. The descriptions say what each member means.

struct FieldError {
    std::string pointer, detail;

    bool operator==(const FieldError&) const = default;
};

struct Problem {
    std::string type = "about:blank", title;
    int status = 500;
    std::string detail;
    std::vector<FieldError> errors;
    std::optional<std::size_t> error_count;
    std::vector<std::string> allow;
};

struct Health {
    std::string status;
};

struct Readiness : Health {
    std::string last_rendered_at;
    std::string without_sandbox;
};

struct Progress {
    std::string id;
    report::Status status = report::Status::queued;
    double progress = 0;
    std::optional<report::Error> error;
};

/// The data of an event.
struct Event : Progress {
    std::string stage;
    std::vector<report::DevicePart> devices;
};

struct ReportLine : Progress {
    std::string url, created_at, finished_at, title, scene;
    nlohmann::json tags = nlohmann::json::object();
    std::vector<std::string> methods;
    std::string spec_sha256;
    nlohmann::json verdict, preview;
    std::string device;
    bool pinned = false;
    std::string broken;
};

struct ReportList {
    std::vector<ReportLine> reports;
    std::string next_cursor;
    std::int64_t count = 0;
    bool count_is_exact = true;
};

/// The findings of the check of an upload; which of them are present depends on the type of the file.
struct AssetFacts {
    std::optional<std::int64_t> width, height, channels;
    std::optional<std::int64_t> triangles, materials, pictures;
    std::optional<std::array<std::int64_t, 3>> size;
    std::optional<std::array<double, 3>> spacing;
    std::string voxel, encoding;
    std::optional<std::array<double, 2>> range;
    std::optional<std::vector<Note>> notes;
};

struct Asset : AssetFacts {
    std::string sha256, type, media_type, name;
    std::int64_t bytes = 0;
    std::string created_at, url, broken;
};

struct AssetKind {
    std::string media_type, type;
    std::vector<std::string> suffixes;
};

struct AssetList {
    std::vector<Asset> assets;
    std::vector<AssetKind> accepts;
    std::uint64_t max_bytes = 0;
};

struct AcceptedReport {
    std::string report, url, title, spec_sha256, device, accepted_at, by, reason;
};

/// A picture of a report that is not done.
struct EarlyPicture {
    std::string label, url;
};

struct EarlyPictures {
    nlohmann::json point = nlohmann::json::object();
    std::vector<EarlyPicture> pictures;
};

struct Pin {
    std::string report, url, pinned_at, by, reason;
};

struct QuotaLine {
    std::string name, what;
    std::int64_t limit = 0;
    double used = 0;
};

struct Session {
    bool required = false;
    std::optional<std::string> name, scope;
    std::vector<QuotaLine> quotas;
};

struct TrendLevel {
    double median = 0;
    std::optional<double> low, high;
    std::size_t reports = 0;
};

struct TrendValue {
    std::string report, created_at;
    double value = 0;
    std::optional<double> low, high;
};

struct TrendChange {
    std::string before, after;
    std::size_t index = 0;
    TrendLevel level_before, level_after;
    double p = 0;
};

struct Trend {
    std::string spec_sha256, device, metric, method, point, unit;
    std::vector<TrendValue> values;
    std::vector<TrendChange> change_points;
    std::size_t missing = 0;
    std::vector<std::string> metrics, methods, points;
};

struct Worker {
    std::string name, label, driver, last_seen_at, report;
};

struct WorkerList {
    std::vector<Worker> workers;
};

struct Baseline {
    std::string name, url;
    std::vector<AcceptedReport> reports;
};

struct BaselineList {
    std::vector<Baseline> baselines;
};

}  // namespace sheer::http::answer

namespace sheer {

template <>
const Description<http::answer::FieldError>& description_of();
template <>
const Description<http::answer::Problem>& description_of();
template <>
const Description<http::answer::Health>& description_of();
template <>
const Description<http::answer::Readiness>& description_of();
template <>
const Description<http::answer::Event>& description_of();
template <>
const Description<http::answer::ReportLine>& description_of();
template <>
const Description<http::answer::ReportList>& description_of();
template <>
const Description<http::answer::AssetFacts>& description_of();
template <>
const Description<http::answer::Asset>& description_of();
template <>
const Description<http::answer::AssetKind>& description_of();
template <>
const Description<http::answer::AssetList>& description_of();
template <>
const Description<http::answer::AcceptedReport>& description_of();
template <>
const Description<http::answer::EarlyPicture>& description_of();
template <>
const Description<http::answer::EarlyPictures>& description_of();
template <>
const Description<http::answer::Pin>& description_of();
template <>
const Description<http::answer::QuotaLine>& description_of();
template <>
const Description<http::answer::Session>& description_of();
template <>
const Description<http::answer::TrendLevel>& description_of();
template <>
const Description<http::answer::TrendValue>& description_of();
template <>
const Description<http::answer::TrendChange>& description_of();
template <>
const Description<http::answer::Trend>& description_of();
template <>
const Description<http::answer::Worker>& description_of();
template <>
const Description<http::answer::WorkerList>& description_of();
template <>
const Description<http::answer::Baseline>& description_of();
template <>
const Description<http::answer::BaselineList>& description_of();

}  // namespace sheer
