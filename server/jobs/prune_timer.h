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

/// Prunes a store from time to time, on a thread of its own.
class PruneTimer {
  public:
    PruneTimer(Store& store, ClockMs clock);
    PruneTimer(const PruneTimer&) = delete;
    PruneTimer& operator=(const PruneTimer&) = delete;
    ~PruneTimer() = default;

    /// From now on, and now; without rules, never.
    void use(std::vector<RetentionRule> rules, std::chrono::milliseconds interval);

  private:
    void run(const std::stop_token& stop);
    void prune_by(const std::vector<RetentionRule>& rules);

    Store& m_store;
    const ClockMs m_clock;
    std::mutex m_mutex;  ///< guards the next three
    std::vector<RetentionRule> m_rules;
    std::chrono::milliseconds m_interval{};
    bool m_changed = false;
    std::condition_variable_any m_wake;
    std::jthread m_thread;
};

}  // namespace sheer
