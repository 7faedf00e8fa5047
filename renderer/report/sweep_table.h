#pragma once
#include <string>

#include "renderer/results/report.h"

namespace sheer {

/// The end of a sweep's table: for each point, a line with each method's speedup over the baseline; then, for each
/// method, the points at which it is resolved to be faster or slower. "" for a report with one point.
std::string sweep_table(const report::Report& report);

}  // namespace sheer
