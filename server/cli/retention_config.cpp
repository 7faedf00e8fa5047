#include "server/cli/retention_config.h"

#include <fmt/format.h>

namespace sheer::cli {

using nlohmann::json;

namespace {

constexpr const char* limits[] = {"max_age_days", "max_reports", "max_bytes"};

Param limit(Param param) {
    param.default_value = nullptr;
    param.optional = true;
    return param;
}

template <typename Number>
std::optional<Number> number_in(const json& rule, const char* name) {
    return rule[name].is_null() ? std::nullopt : std::optional(rule[name].get<Number>());
}

}  // namespace

std::vector<Param> retention_fields() {
    constexpr double most = 1e15, centuries_days = 1e5;
    return {Param::text("tag", "name or name:value of the tag; \"\" for every report", "", 200),
            limit(Param::number("max_age_days", "older ones are removed", "day", 0, 0, centuries_days)),
            limit(Param::integer("max_reports", "all but so many of the newest are removed", "", 0, 0, most)),
            limit(Param::number("max_bytes", "all but the newest with so many bytes together are removed", "byte", 0, 0,
                                most))};
}

void check_retention(const json& rules, const std::string& pointer, std::vector<FieldError>& errors) {
    for (std::size_t i = 0; i < rules.size(); ++i) {
        bool has_limit = false;
        for (const char* name : limits) has_limit = has_limit || !rules[i][name].is_null();
        if (!has_limit)
            errors.push_back({fmt::format("{}/{}", pointer, i), "needs max_age_days, max_reports or max_bytes"});
    }
}

std::vector<RetentionRule> retention_rules(const json& rules) {
    std::vector<RetentionRule> all;
    for (const json& rule : rules)
        all.push_back({.tag = rule["tag"],
                       .max_age_days = number_in<double>(rule, "max_age_days"),
                       .max_reports = number_in<std::int64_t>(rule, "max_reports"),
                       .max_bytes = number_in<double>(rule, "max_bytes")});
    return all;
}

}  // namespace sheer::cli
