#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace sheer {

/// Milliseconds since 1970 UTC. Leases are shared by processes, so they are kept in wall-clock time.
using ClockMs = std::function<std::int64_t()>;

std::int64_t system_now_ms();

/// RFC 3339 in UTC with milliseconds, such as 2024-05-01T12:00:00.250Z.
std::string utc_text(std::int64_t time_ms);
/// The time of such a text, which may lack the milliseconds, or everything after the day; nothing for any other text.
std::optional<std::int64_t> time_of_utc_text(std::string_view text);
/// utc_text() of the current time.
std::string utc_now();

}  // namespace sheer
