#pragma once
#include <nlohmann/json.hpp>

#include "renderer/spec/suites.h"

namespace sheer {

/// What a report says about the suite it was made for: {id, title, source, device, figures: [{at, method, metric,
/// published, measured, ci95}], trends: [{text, verdict, detail}]}, from the `runs` of the report.
///
/// A trend "holds" where the measurement resolves it, "fails" where it resolves the contrary, and is "not resolved"
/// otherwise; two values differ where their 95 % intervals do not meet.
nlohmann::json suite_report(const Suite& suite, const nlohmann::json& runs);

}  // namespace sheer
