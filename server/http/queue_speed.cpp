#include "server/http/queue_speed.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sheer::http {

namespace {

constexpr std::int64_t fresh_ms = 1000;
constexpr int looked_at = 20;
constexpr double longest_s = 60, longest_place_s = 3600;

/// The time that the queue took for each: from the end of the report before it or, if it came later, from its own
/// beginning. That leaves out the times when nothing was waiting. What came before the first one is not known.
double median_seconds(std::vector<ReportSummary> reports) {
    std::ranges::sort(reports, {}, [](const ReportSummary& report) { return report.finished_ms.value_or(0); });
    std::vector<double> seconds;
    for (std::size_t i = reports.size() > 1 ? 1 : 0; i < reports.size(); ++i) {
        const std::int64_t before = i == 0 ? 0 : reports[i - 1].finished_ms.value_or(0);
        const std::int64_t begin = std::max(before, reports[i].created_ms);
        seconds.push_back(static_cast<double>(reports[i].finished_ms.value_or(begin) - begin) / 1000);
    }
    if (seconds.empty()) return 1;
    const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
    std::ranges::nth_element(seconds, middle);
    return *middle;
}

std::chrono::seconds whole(double seconds, double longest) {
    return std::chrono::seconds(static_cast<std::int64_t>(std::ceil(std::clamp(seconds, 1.0, longest))));
}

}  // namespace

QueueSpeed::State QueueSpeed::measured() {
    const std::scoped_lock lock(m_mutex);
    const std::int64_t now_ms = m_clock();
    if (now_ms - m_state.measured_ms < fresh_ms) return m_state;
    m_state.measured_ms = now_ms;
    m_state.seconds_each = median_seconds(m_reports.list({.status = Status::done, .limit = looked_at}).reports);
    m_state.waiting = m_reports.list({.status = Status::queued, .limit = 1}).count +
                      m_reports.list({.status = Status::running, .limit = 1}).count;
    return m_state;
}

std::chrono::seconds QueueSpeed::until_a_place() {
    return whole(measured().seconds_each, longest_place_s);
}

std::chrono::seconds QueueSpeed::until_empty() {
    const State state = measured();
    return whole(state.seconds_each * static_cast<double>(std::max<std::int64_t>(state.waiting, 1)), longest_s);
}

}  // namespace sheer::http
