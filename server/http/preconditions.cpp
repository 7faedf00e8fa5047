#include "server/http/preconditions.h"

#include <algorithm>

#include "server/http/text.h"

namespace sheer::http {

bool is_safe(const std::string& method) {
    return method == "GET" || method == "HEAD" || method == "OPTIONS";
}

Precondition judge_preconditions(const Request& request, const std::string& etag) {
    if (const auto wanted = request.headers.joined("If-Match")) {
        // The strong comparison: a weak tag matches nothing.
        const bool match = std::ranges::any_of(split(*wanted, ','), [&](std::string_view candidate) {
            return candidate == "*" || (!etag.empty() && candidate == etag);
        });
        if (!match) return Precondition::failed;
    }
    const auto known = request.headers.joined("If-None-Match");
    if (!known || !names_etag(*known, etag)) return Precondition::met;
    return request.method == "GET" || request.method == "HEAD" ? Precondition::not_modified : Precondition::failed;
}

}  // namespace sheer::http
