#include "renderer/core/clock.h"

#include <fmt/format.h>

#include <chrono>
#include <ctime>

namespace sheer {

std::int64_t system_now_ms() {
    using namespace std::chrono;
    return duration_cast<milliseconds>(system_clock::now().time_since_epoch()).count();
}

std::string utc_text(std::int64_t time_ms) {
    const std::time_t seconds = time_ms / 1000;
    std::tm utc{};
    gmtime_r(&seconds, &utc);
    return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}Z", utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday,
                       utc.tm_hour, utc.tm_min, utc.tm_sec, time_ms % 1000);
}

std::optional<std::int64_t> time_of_utc_text(std::string_view text) {
    // Each digit stands for one; the parts that may be missing are missing from the end.
    constexpr std::string_view form = "0000-00-00T00:00:00.000Z";
    std::string full(text);
    if (full.size() == 10) full += "T00:00:00Z";
    if (full.size() == 20) full = full.substr(0, 19) + ".000" + full.substr(19);
    if (full.size() != form.size()) return std::nullopt;
    for (std::size_t i = 0; i < form.size(); ++i) {
        const bool is_digit = full[i] >= '0' && full[i] <= '9';
        if (form[i] == '0' ? !is_digit : full[i] != form[i]) return std::nullopt;
    }
    const auto number = [&full](std::size_t from, std::size_t count) { return std::stoi(full.substr(from, count)); };
    using namespace std::chrono;
    const year_month_day day(year(number(0, 4)), month(static_cast<unsigned>(number(5, 2))),
                             std::chrono::day(static_cast<unsigned>(number(8, 2))));
    const int hour = number(11, 2), minute = number(14, 2), second = number(17, 2);
    if (!day.ok() || hour > 23 || minute > 59 || second > 59) return std::nullopt;
    const auto time = sys_days(day) + hours(hour) + minutes(minute) + seconds(second) + milliseconds(number(20, 3));
    return duration_cast<milliseconds>(time.time_since_epoch()).count();
}

std::string utc_now() {
    return utc_text(system_now_ms());
}

}  // namespace sheer
