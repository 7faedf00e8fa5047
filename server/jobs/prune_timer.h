#pragma once
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "renderer/core/clock.h"
#include "server/jobs/retention.h"
#include "server/jobs/store.h"

namespace sheer {

/// Removes the reports; those that were pinned or accepted meanwhile stay. Returns what it removed.
std::vector<PrunedReport> prune(Store& store, const std::vector<PrunedReport>& reports);

/// Prunes a store from time to time, on a thread of its own; without rules, never.
class PruneTimer {
  public:
    PruneTimer(Store& store, std::vector<RetentionRule> rules, std::chrono::milliseconds interval, ClockMs clock);
    PruneTimer(const PruneTimer&) = delete;
    PruneTimer& operator=(const PruneTimer&) = delete;
    ~PruneTimer() = default;

  private:
    void run(const std::stop_token& stop);
    void prune_now();

    Store& m_store;
    const std::vector<RetentionRule> m_rules;
    const std::chrono::milliseconds m_interval;
    const ClockMs m_clock;
    std::mutex m_mutex;
    std::condition_variable_any m_wake;
    std::jthread m_thread;
};

}  // namespace sheer
