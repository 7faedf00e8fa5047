#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace sheer {

// The words for an entry of a report's `checks`, for every table and file that lists them.

/// passed, failed, or undecided.
std::string check_outcome(const nlohmann::json& check);
/// " at least 0.9 at most 2", of what limits there are.
std::string check_limits(const nlohmann::json& check);
/// "flip.mean of f2bd at most 0.05 at count 16": the same whatever was measured.
std::string check_name(const nlohmann::json& check);
/// What was measured, with enough digits to see on which side of the limits it lies; words where that is no number.
std::string check_value(const nlohmann::json& check);

}  // namespace sheer
