#include "server/http/guard.h"

#include <boost/beast/core/string.hpp>
#include <boost/url/parse.hpp>

#include "server/http/preconditions.h"
#include "server/http/problem.h"
#include "server/http/text.h"

namespace sheer::http {

namespace {

constexpr const char* readable_headers =
    "Accept-Ranges, Content-Range, ETag, Location, Preference-Applied, Retry-After";
constexpr const char* sendable_headers =
    "Accept, Authorization, Content-Type, Idempotency-Key, If-Match, If-None-Match, Last-Event-ID, Prefer, Range";
constexpr const char* preflight_lasts_s = "600";

bool is_own_origin(const std::string& origin, const std::string& host) {
    return boost::beast::iequals(origin, "http://" + host) || boost::beast::iequals(origin, "https://" + host);
}

}  // namespace

std::optional<Response> Guard::refusal(const Request& request) const {
    const std::string host = request.headers.find("Host").value_or("");
    if (!hosts.empty() && !hosts.contains(host_name(host)))
        return problem(421, "This service does not answer for the host \"" + host + "\".");
    if (is_safe(request.method)) return std::nullopt;
    if (is_friend(request)) return std::nullopt;
    const auto origin = request.headers.find("Origin");
    const auto site = request.headers.find("Sec-Fetch-Site");
    if ((origin && !is_own_origin(*origin, host)) || (site && *site == "cross-site"))
        return problem(403, "Pages from other sites may not change anything here.");
    return std::nullopt;
}

bool Guard::is_friend(const Request& request) const {
    const auto origin = request.headers.find("Origin");
    return origin && origins.contains(*origin);
}

void Guard::permit(const Request& request, Headers& headers) const {
    if (origins.empty()) return;
    headers.add("Vary", "Origin");
    if (!is_friend(request)) return;
    headers.add("Access-Control-Allow-Origin", *request.headers.find("Origin"));
    headers.add("Access-Control-Expose-Headers", readable_headers);
    if (request.method != "OPTIONS" || !request.headers.contains("Access-Control-Request-Method")) return;
    headers.add("Access-Control-Allow-Methods", headers.find("Allow").value_or(""));
    headers.add("Access-Control-Allow-Headers", sendable_headers);
    headers.add("Access-Control-Max-Age", preflight_lasts_s);
}

Guard make_guard(bool on_loopback, std::set<std::string> allowed, std::set<std::string> origins) {
    if (on_loopback || !allowed.empty()) allowed.insert({"localhost", "127.0.0.1", "[::1]"});
    return {std::move(allowed), std::move(origins)};
}

std::string wrong_origin(const std::string& origin) {
    const auto url = boost::urls::parse_uri(origin);
    const bool is_origin = url && (url->scheme() == "http" || url->scheme() == "https") &&
                           !url->encoded_host().empty() && !url->has_userinfo() && url->encoded_path().empty() &&
                           !url->has_query() && !url->has_fragment();
    return is_origin ? "" : "must be an origin such as https://ci.example, without a path";
}

}  // namespace sheer::http
