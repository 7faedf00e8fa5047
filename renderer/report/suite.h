#pragma once
#include <vector>

#include "renderer/results/report.h"
#include "renderer/spec/suites.h"

namespace sheer {

/// A report's section on the suite for which it was made, from the `runs` of the report.
///
/// A trend "holds" if the measurement resolves it, "fails" if it resolves the opposite, and is "not resolved"
/// otherwise; two values differ if their 95 % intervals do not overlap.
report::Suite suite_report(const Suite& suite, const std::vector<report::Run>& runs);

}  // namespace sheer
