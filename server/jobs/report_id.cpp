#include "server/jobs/report_id.h"

#include <fmt/format.h>
#include <sys/random.h>

#include <cerrno>
#include <system_error>

namespace sheer {

namespace {

constexpr std::uint32_t counter_end = 1u << 12;
// Half of the counter's range stays free, so that the ids of one millisecond rarely overflow into the next.
constexpr std::uint32_t counter_start_mask = (counter_end >> 1) - 1;

std::uint64_t random_bits() {
    std::uint64_t bits = 0;
    if (getrandom(&bits, sizeof bits, 0) != static_cast<ssize_t>(sizeof bits))
        throw std::system_error(errno, std::generic_category(), "getrandom");
    return bits;
}

}  // namespace

ReportIds::ReportIds(ClockMs clock) : m_clock(std::move(clock)) {}

std::string ReportIds::next() {
    const std::uint64_t random = random_bits();
    const std::lock_guard lock(m_mutex);
    const std::int64_t now_ms = m_clock();
    if (now_ms > m_last_ms) {
        m_last_ms = now_ms;
        m_counter = static_cast<std::uint32_t>(random_bits()) & counter_start_mask;
    } else if (++m_counter == counter_end) {
        ++m_last_ms;
        m_counter = 0;
    }
    const auto time = static_cast<std::uint64_t>(m_last_ms);
    return fmt::format("{:08x}-{:04x}-7{:03x}-{:04x}-{:012x}", (time >> 16) & 0xffffffffu, time & 0xffffu, m_counter,
                       0x8000u | ((random >> 48) & 0x3fffu), random & 0xffffffffffffu);
}

bool is_report_id(std::string_view text) {
    if (text.size() != 36) return false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool dash = i == 8 || i == 13 || i == 18 || i == 23;
        const char c = text[i];
        const bool hex = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
        if (dash ? c != '-' : !hex) return false;
    }
    return true;
}

}  // namespace sheer
