#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace sheer {

/// What a store's jobs do and did, over all processes.
struct ActivityCounts {
    std::map<std::string, std::int64_t> reports;   ///< by status
    std::optional<std::int64_t> oldest_queued_ms;  ///< when the job that waits longest was queued
    std::map<std::string, double> stage_seconds;   ///< of renderers, by kind of stage
    std::int64_t lost_leases = 0;
    std::map<std::string, std::int64_t> workers;  ///< those that run a job, by label
};

class Activity {
  public:
    virtual ~Activity() = default;
    virtual ActivityCounts counts() = 0;
};

/// "timing" of "count 16: timing round 3 of 10"; "" of "".
std::string kind_of_stage(const std::string& stage);

}  // namespace sheer
