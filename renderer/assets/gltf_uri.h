#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace sheer {

/// The percent-decoded text (RFC 3986, section 2.1).
std::string percent_decoded(std::string_view text);

/// The bytes within a data: URI (RFC 2397), whatever its media type, in base64 (RFC 4648) or percent-encoded; nothing
/// for any other URI. Throws AssetError for invalid base64.
std::optional<std::string> decode_data_uri(std::string_view uri);

}  // namespace sheer
