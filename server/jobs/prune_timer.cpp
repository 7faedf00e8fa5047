#include "server/jobs/prune_timer.h"

#include <spdlog/spdlog.h>

namespace sheer {

std::vector<PrunedReport> prune(Store& store, const std::vector<PrunedReport>& reports) {
    std::vector<PrunedReport> removed;
    for (const PrunedReport& report : reports)
        if (store.reports().remove(report.id) == ReportArchive::Removal::deleted) removed.push_back(report);
    return removed;
}

PruneTimer::PruneTimer(Store& store, std::vector<RetentionRule> rules, std::chrono::milliseconds interval,
                       ClockMs clock)
    : m_store(store), m_rules(std::move(rules)), m_interval(interval), m_clock(std::move(clock)) {
    if (!m_rules.empty()) m_thread = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void PruneTimer::run(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
        prune_now();
        std::unique_lock lock(m_mutex);
        m_wake.wait_for(lock, stop, m_interval, [] { return false; });
    }
}

void PruneTimer::prune_now() {
    try {
        const auto planned = reports_to_prune(m_store.care().stored_reports(), m_rules, m_clock());
        for (const PrunedReport& report : prune(m_store, planned))
            spdlog::info("report {} is removed: {}", report.id, report.reason);
    } catch (const StoreError& error) {
        spdlog::error("the archive is not pruned: {}", error.what());
    }
}

}  // namespace sheer
