#pragma once
#include <string>
#include <string_view>

namespace sheer {

/// Lower-case hexadecimal SHA-256 (FIPS 180-4). Throws std::runtime_error if the library cannot compute it.
std::string sha256_hex(std::string_view bytes);

/// Whether `text` is 64 digits of lower-case hexadecimal.
bool is_sha256(std::string_view text);

}  // namespace sheer
