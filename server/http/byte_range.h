#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

#include "server/jobs/content.h"

namespace sheer::http {

/// Bytes from `begin` up to, but not including, `end`.
struct ByteRange {
    std::uint64_t begin = 0, end = 0;

    bool operator==(const ByteRange&) const = default;
};

/// What a Range field (RFC 9110, 14.2) asks of `size` bytes. None if it is not one range of bytes, which means the
/// whole; an empty range if no byte of it exists (416).
std::optional<ByteRange> byte_range(std::string_view field, std::uint64_t size);

/// A part of a content.
ContentPtr slice_of(ContentPtr whole, ByteRange range);

}  // namespace sheer::http
