#pragma once
#include <cstdint>

namespace sheer {

/// The largest report.json of a renderer that is read.
inline constexpr std::uint64_t max_report_bytes = std::uint64_t{128} << 20;
/// The largest picture of a report that is read.
inline constexpr std::uint64_t max_picture_bytes = std::uint64_t{512} << 20;

}  // namespace sheer
