#pragma once
#include <string>

#include "renderer/results/report.h"

namespace sheer {

// The words for an entry of a report's `checks`, for every table and file that lists them.

/// " at least 0.9 at most 2": those limits that exist.
std::string check_limits(const report::Check& check);
/// "flip.mean of f2bd at count 16": independent of what was measured and of the limits.
std::string check_name(const report::Check& check);
/// What was measured, with enough digits to see on which side of the limits it lies; words if it is not a number.
std::string check_value(const report::Check& check);

}  // namespace sheer
