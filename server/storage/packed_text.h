#pragma once
#include <string>
#include <string_view>

namespace sheer {

/// `text` compressed, with its length in front.
std::string pack_text(std::string_view text);
/// The same for bytes that are read by the thousand: kept as they are unless compressing halves them, since numbers
/// hardly become smaller, and take ten times as long to read.
std::string pack_numbers(std::string_view bytes);
/// What pack_text() or pack_numbers() was given. Throws DamagedData if `packed` did not come from them, and for more
/// than `max_bytes`.
std::string unpack_text(std::string_view packed, std::size_t max_bytes);

}  // namespace sheer
