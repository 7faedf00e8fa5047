#pragma once
#include <string>
#include <string_view>

namespace sheer {

/// The bytes as a data: URI (RFC 2397) in base64.
std::string data_uri(const std::string& media_type, std::string_view bytes);

}  // namespace sheer
