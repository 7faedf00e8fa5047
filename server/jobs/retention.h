#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/jobs/care.h"

namespace sheer {

/// How long reports are kept. A report that exceeds any of the limits is removed.
struct RetentionRule {
    std::string tag;  ///< "name" or "name:value"; "" for every report
    std::optional<double> max_age_days;
    std::optional<std::int64_t> max_reports;  ///< the newest
    std::optional<double> max_bytes;          ///< of their texts and pictures, from the newest on
};

struct PrunedReport {
    std::string id;
    std::uint64_t bytes = 0;
    std::string reason;  ///< such as "older than 30 days"
};

/// What the rules remove, oldest first. The first rule whose tag a report has decides about it; without such a rule it
/// is kept. Reports that are kept in any case count for no rule. `reports`: newest first.
std::vector<PrunedReport> reports_to_prune(const std::vector<StoredReport>& reports,
                                           const std::vector<RetentionRule>& rules, std::int64_t now_ms);

}  // namespace sheer
