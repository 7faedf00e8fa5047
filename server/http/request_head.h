#pragma once
#include <optional>

#include "server/http/message.h"

namespace sheer::http {

/// Checks a syntactically correct head of a request for what HTTP/1.1 requires beyond the grammar, and converts a
/// target in absolute form to the usual one. `version` is 10 for HTTP/1.0, 11 for HTTP/1.1. Returns the problem after
/// which the connection must end, since it is unknown what comes next on it:
///   505 for a version other than 1.x,
///   400 without exactly one Host (HTTP/1.1), or with an invalid one (RFC 9112, 3.2),
///   400 for a Transfer-Encoding that is malformed or in HTTP/1.0, 501 for one other than exactly `chunked` (6.1),
///   400 for a target that is neither a path nor an http URL (3.2).
std::optional<Response> check_head(Request& request, unsigned version);

}  // namespace sheer::http
