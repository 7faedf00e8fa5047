#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace sheer {

/// The end of a sweep's table: a line a point with each method's speedup over the baseline, then for each method where
/// it is resolved to be faster or slower. "" for a report of one point.
std::string sweep_table(const nlohmann::json& report);

}  // namespace sheer
