#include "server/jobs/prune_timer.h"

#include <spdlog/spdlog.h>

namespace sheer {

std::vector<PrunedReport> prune(Store& store, const std::vector<PrunedReport>& reports) {
    std::vector<PrunedReport> removed;
    for (const PrunedReport& report : reports)
        if (store.reports().remove(report.id) == ReportArchive::Removal::deleted) removed.push_back(report);
    return removed;
}

PruneTimer::PruneTimer(Store& store, ClockMs clock)
    : m_store(store), m_clock(std::move(clock)), m_thread([this](const std::stop_token& stop) { run(stop); }) {}

void PruneTimer::use(std::vector<RetentionRule> rules, std::chrono::milliseconds interval) {
    {
        const std::lock_guard lock(m_mutex);
        m_rules = std::move(rules);
        m_interval = interval;
        m_changed = true;
    }
    m_wake.notify_all();
}

void PruneTimer::run(const std::stop_token& stop) {
    std::unique_lock lock(m_mutex);
    while (!stop.stop_requested()) {
        const auto changed = [this] { return m_changed; };
        if (m_rules.empty()) {
            m_wake.wait(lock, stop, changed);
        } else {
            m_wake.wait_for(lock, stop, m_interval, changed);
        }
        m_changed = false;
        const std::vector<RetentionRule> rules = m_rules;
        lock.unlock();
        if (!rules.empty() && !stop.stop_requested()) prune_by(rules);
        lock.lock();
    }
}

void PruneTimer::prune_by(const std::vector<RetentionRule>& rules) {
    try {
        const auto planned = reports_to_prune(m_store.care().stored_reports(), rules, m_clock());
        for (const PrunedReport& report : prune(m_store, planned))
            spdlog::info("report {} is removed: {}", report.id, report.reason);
    } catch (const StoreError& error) {
        spdlog::error("the archive is not pruned: {}", error.what());
    }
}

}  // namespace sheer
