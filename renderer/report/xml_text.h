#pragma once
#include <string>
#include <string_view>

namespace sheer {

/// `text` as it may stand in an attribute's value, in either kind of quotes, and between tags: markup is escaped, tabs
/// and line ends are references, and what XML 1.0 has no place for, even escaped (its production Char: most control
/// characters, surrogates, U+FFFE and U+FFFF), or what is no UTF-8, becomes U+FFFD.
std::string xml_text(std::string_view text);

}  // namespace sheer
