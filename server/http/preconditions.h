#pragma once
#include <string>

#include "server/http/message.h"

namespace sheer::http {

/// GET, HEAD, OPTIONS: a request that changes nothing (RFC 9110, 9.2.1).
bool is_safe(const std::string& method);

enum class Precondition { met, failed, not_modified };

/// Evaluates If-Match and If-None-Match for an existing target with this ETag, "" for none (RFC 9110, 13).
/// `not_modified` only for GET and HEAD; for other methods that is a failure.
Precondition judge_preconditions(const Request& request, const std::string& etag);

}  // namespace sheer::http
