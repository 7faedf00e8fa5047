#pragma once
#include <chrono>
#include <mutex>

#include "renderer/core/clock.h"
#include "server/jobs/report_archive.h"

namespace sheer::http {

/// How fast the workers work through the queue, from the last reports that ended. It is read from the archive at most
/// once a second. Thread-safe.
class QueueSpeed {
  public:
    QueueSpeed(ReportArchive& reports, ClockMs clock) : m_reports(reports), m_clock(std::move(clock)) {}

    /// Until a full queue has a place again; at least a second.
    std::chrono::seconds until_a_place();
    /// Until everything that is queued or running now has ended; at least a second, at most a minute, since a client
    /// also wants to show progress.
    std::chrono::seconds until_empty();

  private:
    struct State {
        std::int64_t measured_ms = -1'000'000;
        double seconds_each = 1;
        std::int64_t waiting = 0;
    };

    State measured();

    ReportArchive& m_reports;
    ClockMs m_clock;
    std::mutex m_mutex;
    State m_state;
};

}  // namespace sheer::http
