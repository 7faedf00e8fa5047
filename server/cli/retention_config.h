#pragma once
#include <nlohmann/json.hpp>
#include <vector>

#include "renderer/params/param.h"
#include "server/jobs/retention.h"

namespace sheer::cli {

/// The fields of a rule.
std::vector<Param> retention_fields();
/// Adds an error for each rule that has no limit.
void check_retention(const nlohmann::json& rules, const std::string& pointer, std::vector<FieldError>& errors);
/// From normalised JSON.
std::vector<RetentionRule> retention_rules(const nlohmann::json& rules);

}  // namespace sheer::cli
