#pragma once
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "renderer/params/described.h"
#include "renderer/results/report.h"

namespace sheer::pixel {

// The fragments of a pixel, and the methods' results, as types. The descriptions say what each member means.

/// Red, green, blue. In JSON, a channel that is not finite is null.
struct Color {
    std::array<double, 3> rgb{};

    double operator[](std::size_t channel) const { return rgb[channel]; }
    bool operator==(const Color&) const = default;
};

struct Fragment {
    double depth = 0;
    Color color;
    double alpha = 0;
    std::uint32_t primitive = 0;
    double transmittance_before = 1, weight = 0;
};

struct Opaque {
    double depth = 0;
    Color color;
};

struct ReferenceAtPixel {
    std::string method;
    Color value, difference;
};

enum class FactKind { number, color, fragment, fragments, samples };

struct Fact {
    std::string name;
    FactKind kind = FactKind::number;
    nlohmann::json value;
    std::string text;
};

struct MethodAtPixel {
    std::string method, label;
    report::ResultStatus status = report::ResultStatus::ok;
    std::string reason;
    std::optional<Color> value, difference;
    OrReason<std::int64_t> shaded, needed, saturated_at;
    std::optional<std::vector<Fact>> explanation;
    std::optional<Color> explained_value;
    std::string explanation_reason;
};

struct Pixel {
    int x = 0, y = 0;
    report::Point point = nlohmann::json::object();
    Color background;
    std::optional<Opaque> opaque;
    std::vector<Fragment> fragments;
    double transmittance = 1;
    Color sum;
    ReferenceAtPixel reference;
    std::vector<MethodAtPixel> methods;
};

}  // namespace sheer::pixel

namespace sheer {

template <>
struct Words<pixel::FactKind> {
    using enum pixel::FactKind;
    static constexpr std::pair<pixel::FactKind, const char*> all[] = {
        {number, "number"}, {color, "color"}, {fragment, "fragment"}, {fragments, "fragments"}, {samples, "samples"}};
};

template <>
const Description<pixel::Fragment>& description_of();
template <>
const Description<pixel::Opaque>& description_of();
template <>
const Description<pixel::ReferenceAtPixel>& description_of();
template <>
const Description<pixel::Fact>& description_of();
template <>
const Description<pixel::MethodAtPixel>& description_of();
template <>
const Description<pixel::Pixel>& description_of();

namespace detail {

template <>
struct Codec<pixel::Color> {
    static nlohmann::json write(const pixel::Color& color);
    static void read(const nlohmann::json& from, pixel::Color& to);
    static nlohmann::json schema(SchemaBook& book);
};

}  // namespace detail

}  // namespace sheer
