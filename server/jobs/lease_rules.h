#pragma once
#include <algorithm>
#include <cstdint>

#include "server/jobs/status.h"

namespace sheer {

/// A worker that runs a job holds a lease on it, which it renews by heartbeats. If a lease expires the worker is gone,
/// and another worker gets the job.
struct LeaseRules {
    std::int64_t lease_ms = 10'000;
    std::int64_t heartbeat_ms = 1'000;
    int max_attempts = 2;                   ///< a job that crashes its worker or renderer this often is given up
    int max_setbacks = 12;                  ///< a job that fails this often because of the disk is given up
    std::int64_t first_setback_ms = 1'000;  ///< wait until it is tried again; doubled each time
    std::int64_t longest_setback_ms = 300'000;
};

/// How long a job waits after its setback number `setbacks`.
inline std::int64_t setback_ms(int setbacks, const LeaseRules& rules) {
    std::int64_t wait_ms = rules.first_setback_ms;
    for (int i = 1; i < setbacks && wait_ms < rules.longest_setback_ms; ++i) wait_ms *= 2;
    return std::min(wait_ms, rules.longest_setback_ms);
}

/// The next status of a job whose attempt number `attempts` (from 1) ended without a report, through no fault of the
/// spec.
inline Status after_lost_attempt(int attempts, bool cancel_requested, const LeaseRules& rules) {
    if (cancel_requested) return Status::cancelled;
    return attempts < rules.max_attempts ? Status::queued : Status::failed;
}

}  // namespace sheer
