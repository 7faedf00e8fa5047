#include "server/jobs/retention.h"

#include <fmt/format.h>

#include <algorithm>

namespace sheer {

namespace {

constexpr double ms_per_day = 86'400'000;

bool applies(const RetentionRule& rule, const nlohmann::json& tags) {
    const std::size_t colon = rule.tag.find(':');
    const auto found = tags.find(rule.tag.substr(0, colon));
    if (rule.tag.empty()) return true;
    return found != tags.end() && (colon == std::string::npos || *found == rule.tag.substr(colon + 1));
}

/// What a rule has kept so far.
struct Kept {
    std::int64_t reports = 0;
    double bytes = 0;
};

/// Why the rule removes the next older report; "" if it keeps it.
std::string reason_to_remove(const RetentionRule& rule, const Kept& kept, const StoredReport& report,
                             std::int64_t now_ms) {
    if (rule.max_age_days && static_cast<double>(now_ms - report.created_ms) > *rule.max_age_days * ms_per_day)
        return fmt::format("older than {} days", *rule.max_age_days);
    if (rule.max_reports && kept.reports >= *rule.max_reports)
        return fmt::format("not among the newest {} reports", *rule.max_reports);
    if (rule.max_bytes && kept.bytes + static_cast<double>(report.bytes) > *rule.max_bytes)
        return fmt::format("beyond the newest {} bytes", *rule.max_bytes);
    return "";
}

}  // namespace

std::vector<PrunedReport> reports_to_prune(const std::vector<StoredReport>& reports,
                                           const std::vector<RetentionRule>& rules, std::int64_t now_ms) {
    std::vector<Kept> kept(rules.size());
    std::vector<PrunedReport> pruned;
    for (const StoredReport& report : reports) {
        if (report.is_kept) continue;
        const auto rule = std::ranges::find_if(rules, [&](const auto& each) { return applies(each, report.tags); });
        if (rule == rules.end()) continue;
        Kept& so_far = kept[static_cast<std::size_t>(rule - rules.begin())];
        // Once a report does not fit, no older one does.
        std::string reason = reason_to_remove(*rule, so_far, report, now_ms);
        if (reason.empty()) {
            ++so_far.reports;
            so_far.bytes += static_cast<double>(report.bytes);
        } else {
            if (rule->max_bytes) so_far.bytes = *rule->max_bytes;
            pruned.push_back({report.id, report.bytes, rule->tag.empty() ? reason : rule->tag + ": " + reason});
        }
    }
    std::ranges::reverse(pruned);
    return pruned;
}

}  // namespace sheer
