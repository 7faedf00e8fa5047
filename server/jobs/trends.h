#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/jobs/report_archive.h"

namespace sheer {

/// The numbers of a report, kept apart from its text: see renderer/files/trend_values.h.
struct ReportNumbers {
    std::string names;    ///< JSON text, which the reports of one spec share
    std::string numbers;  ///< as bytes
};

struct TrendReport {
    std::string id;
    std::int64_t created_ms = 0;
    std::optional<ReportNumbers> numbers;  ///< none for a report of an older version, or with a damaged row
};

class Trends {
  public:
    virtual ~Trends() = default;
    /// Done reports that match the filter, at most `limit` of the newest, oldest first. Only the filter's facets count.
    virtual std::vector<TrendReport> reports(const ListFilter& filter) = 0;
    /// For a report that has none.
    virtual void keep(const std::string& report_id, const ReportNumbers& numbers) = 0;
};

}  // namespace sheer
