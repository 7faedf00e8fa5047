#pragma once
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>

#include "renderer/core/clock.h"

namespace sheer {

/// Makes the ids of reports: UUID version 7 (RFC 9562), so that their order as text is their order in time. The ids of
/// one object are strictly increasing, even within a millisecond and when the clock is set back. Thread-safe.
class ReportIds {
  public:
    explicit ReportIds(ClockMs clock);
    /// Throws std::system_error if the system has no random bytes to give.
    std::string next();

  private:
    ClockMs m_clock;
    std::mutex m_mutex;
    std::int64_t m_last_ms = 0;
    std::uint32_t m_counter = 0;
};

/// Whether `text` has the form of a UUID in lower case.
bool is_report_id(std::string_view text);

}  // namespace sheer
