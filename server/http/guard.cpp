#include "server/http/guard.h"

#include <boost/beast/core/string.hpp>

#include "server/http/preconditions.h"
#include "server/http/problem.h"
#include "server/http/text.h"

namespace sheer::http {

namespace {

bool is_own_origin(const std::string& origin, const std::string& host) {
    return boost::beast::iequals(origin, "http://" + host) || boost::beast::iequals(origin, "https://" + host);
}

}  // namespace

std::optional<Response> Guard::refusal(const Request& request) const {
    const std::string host = request.headers.find("Host").value_or("");
    if (!hosts.empty() && !hosts.contains(host_name(host)))
        return problem(421, "This service does not answer for the host \"" + host + "\".");
    if (is_safe(request.method)) return std::nullopt;
    const auto origin = request.headers.find("Origin");
    const auto site = request.headers.find("Sec-Fetch-Site");
    if ((origin && !is_own_origin(*origin, host)) || (site && *site == "cross-site"))
        return problem(403, "Pages from other sites may not change anything here.");
    return std::nullopt;
}

Guard make_guard(bool on_loopback, std::set<std::string> allowed) {
    if (on_loopback || !allowed.empty()) allowed.insert({"localhost", "127.0.0.1", "[::1]"});
    return {std::move(allowed)};
}

}  // namespace sheer::http
