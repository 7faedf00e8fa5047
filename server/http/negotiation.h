#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "server/http/body_cache.h"
#include "server/http/message.h"

namespace sheer::http {

/// Whether an Accept field (RFC 9110, 12.5.1) allows an answer of this type, which may be a range such as "image/*".
/// Without a field everything is allowed.
bool accepts(const std::optional<std::string>& accept, std::string_view media_type);

/// Whether an Accept-Encoding field allows gzip.
bool accepts_gzip(const std::optional<std::string>& accept_encoding);

/// The text as a gzip file (RFC 1952).
std::string gzipped(std::string_view text);

/// Decides whether to compress the body of an answer: if that is worth it and the request allows it. The compressed
/// form is another representation, so it has an ETag of its own, which `without_coding` leads back to the original's.
void choose_coding(Response& response, const Request& request);
/// With its body in the coding that was chosen. `known` keeps what has an ETag, by that and the target.
Response encoded(Response response, const std::string& target, BodyCache& known);
/// The same if that takes no compressing; otherwise nothing.
std::optional<Response> encoded_if_known(Response response, const std::string& target, BodyCache& known);

/// The request with the ETags of the original in place of those of compressed forms.
Request without_coding(Request request);

}  // namespace sheer::http
