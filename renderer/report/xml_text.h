#pragma once
#include <string>
#include <string_view>

namespace sheer {

/// `text` with U+FFFD in place of bytes that are not UTF-8 and of characters that XML 1.0 does not allow even escaped
/// (its production Char): most control characters, surrogates, U+FFFE and U+FFFF. pugixml escapes markup, but writes
/// these as they are or as references.
std::string xml_text(std::string_view text);

}  // namespace sheer
