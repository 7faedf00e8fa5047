#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace sheer {

/// The number that a metric's name means in a result of a report, such as flip.mean, timing.median or speedup; null
/// where it was not measured.
nlohmann::json measured(const nlohmann::json& result, const std::string& metric);

/// Why it was not measured: the reason that the report has beside the metric's null.
std::string no_measure_reason(const nlohmann::json& result, const std::string& metric);

/// A number and how far it may be off: low and high are the number where a metric is exact, and infinite where it has
/// an interval but too few samples for one.
struct Measured {
    double value, low, high;
};

/// None where it was not measured.
std::optional<Measured> measured_with_interval(const nlohmann::json& result, const std::string& metric);

/// The result of a run with this label; null if there is none.
const nlohmann::json* find_result(const nlohmann::json& run, const std::string& label);

}  // namespace sheer
