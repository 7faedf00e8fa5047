#pragma once
#include <string>
#include <string_view>

namespace sheer {

/// Lower-case hexadecimal SHA-256 (FIPS 180-4). Throws std::runtime_error if the library cannot do it.
std::string sha256_hex(std::string_view bytes);

}  // namespace sheer
