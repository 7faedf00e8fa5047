#include "renderer/files/trend_values.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace sheer {

using nlohmann::json;

namespace {

constexpr std::size_t most_points = 64;
constexpr std::size_t bytes_per_value = 3 * sizeof(double);
static_assert(std::endian::native == std::endian::little, "archives are read on other machines");

}  // namespace

TrendValues trend_values(const report::Report& report) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    TrendValues all;
    for (std::size_t run = 0; run < std::min(report.runs.size(), most_points); ++run) {
        const std::string point = json(report.runs[run].point).dump();
        for (const report::Result& result : report.runs[run].results)
            for (const Quantity& quantity : all_quantities()) {
                const auto measured = quantity.measure ? quantity.measure(result) : std::nullopt;
                all.names.push_back({point, result.label, quantity.name});
                all.values.push_back(measured.value_or(Measured{none, none, none}));
            }
    }
    return all;
}

std::string trend_names_text(const TrendValues& values) {
    json names = json::array();
    for (const TrendName& name : values.names) names.push_back({name.point, name.method, name.metric});
    return names.dump();
}

std::vector<TrendName> trend_names(const std::string& text) {
    std::vector<TrendName> names;
    const json document = json::parse(text, nullptr, false);
    if (!document.is_array()) return names;
    for (const json& name : document) {
        if (!name.is_array() || name.size() != 3) return {};
        names.push_back({name[0].get<std::string>(), name[1].get<std::string>(), name[2].get<std::string>()});
    }
    return names;
}

std::string trend_numbers(const TrendValues& values) {
    std::string bytes;
    for (const Measured& value : values.values)
        for (const double number : {value.value, value.low, value.high}) {
            char of_number[sizeof number];
            std::memcpy(of_number, &number, sizeof number);
            bytes.append(of_number, sizeof number);
        }
    return bytes;
}

std::optional<Measured> trend_number(const std::string& numbers, std::size_t index) {
    if ((index + 1) * bytes_per_value > numbers.size()) return std::nullopt;
    double three[3];
    std::memcpy(three, numbers.data() + index * bytes_per_value, bytes_per_value);
    if (!std::isfinite(three[0])) return std::nullopt;
    return Measured{three[0], three[1], three[2]};
}

}  // namespace sheer
