#pragma once
#include <optional>

#include "server/http/message.h"

namespace sheer::http {

/// Holds the head of a request, which a parser has found well-formed, against what HTTP/1.1 asks beyond the grammar,
/// and brings a target in absolute form into the usual one. `version` is 10 for HTTP/1.0, 11 for HTTP/1.1. Returns the
/// problem after which the connection must end, since nobody knows what comes next on it:
///   505 for another version than 1.x,
///   400 without exactly one Host (HTTP/1.1), or with one that is none (RFC 9112, 3.2),
///   400 for a Transfer-Encoding that is ill-formed or in HTTP/1.0, 501 for another one than exactly `chunked` (6.1),
///   400 for a target that is neither a path nor an http URL (3.2).
std::optional<Response> check_head(Request& request, unsigned version);

}  // namespace sheer::http
