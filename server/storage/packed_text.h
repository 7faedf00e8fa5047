#pragma once
#include <string>
#include <string_view>

namespace sheer {

/// `text` compressed, with its length in front.
std::string pack_text(std::string_view text);
/// What pack_text() was given. Throws DamagedData if `packed` did not come from it, and for more than `max_bytes`.
std::string unpack_text(std::string_view packed, std::size_t max_bytes);

}  // namespace sheer
