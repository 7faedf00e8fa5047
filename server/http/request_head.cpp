#include "server/http/request_head.h"

#include <algorithm>
#include <cctype>

#include "server/http/problem.h"
#include "server/http/text.h"

namespace sheer::http {

namespace {

/// RFC 9110, 5.6.2.
bool is_token(std::string_view text) {
    return !text.empty() && std::ranges::all_of(text, [](unsigned char c) {
        return std::isalnum(c) || std::string_view("!#$%&'*+-.^_`|~").find(static_cast<char>(c)) != std::string::npos;
    });
}

/// A name or an address with or without a port; what could be one is taken.
bool is_authority(std::string_view text) {
    return std::ranges::all_of(text, [](unsigned char c) {
        return std::isalnum(c) || c >= 0x80 ||
               std::string_view("-._~%!$&'()*+,;=:[]").find(static_cast<char>(c)) != std::string::npos;
    });
}

std::optional<Response> check_host(const Request& request, unsigned version) {
    const std::size_t count = request.headers.count("Host");
    if (count > 1 || (count == 0 && version >= 11)) return problem(400, "An HTTP/1.1 request has exactly one Host.");
    if (count == 1 && !is_authority(*request.headers.find("Host"))) return problem(400, "This Host is none.");
    return std::nullopt;
}

std::optional<Response> check_transfer_encoding(const Request& request, unsigned version) {
    const auto encoding = request.headers.joined("Transfer-Encoding");
    if (!encoding) return std::nullopt;
    const auto codings = split(*encoding, ',');
    const auto is_chunked = [](std::string_view coding) { return equal_ignoring_case(coding, "chunked"); };
    const bool well_formed =
        std::ranges::all_of(codings,
                            [](std::string_view coding) { return is_token(trimmed(split(coding, ';').front())); }) &&
        std::none_of(codings.begin(), codings.end() - 1, is_chunked);
    if (!well_formed || version < 11) return problem(400, "This Transfer-Encoding is ill-formed.");
    if (codings.size() == 1 && is_chunked(codings.front())) return std::nullopt;
    return problem(501, "The only Transfer-Encoding that is understood is chunked.");
}

/// Takes "http://HOST/PATH?QUERY" apart (RFC 9112, 3.2.2): the host goes before that of the Host field.
std::optional<Response> check_target(Request& request) {
    const std::string target = request.target;
    if (target.starts_with('/') || request.method == "CONNECT" || (request.method == "OPTIONS" && target == "*"))
        return std::nullopt;
    const std::size_t scheme_end = target.find("://");
    const std::string_view scheme = std::string_view(target).substr(0, std::min(scheme_end, target.size()));
    if (!equal_ignoring_case(scheme, "http") && !equal_ignoring_case(scheme, "https"))
        return problem(400, "The target of the request is neither a path nor an http URL.");
    const std::size_t begin = scheme_end + 3, end = std::min(target.find_first_of("/?#", begin), target.size());
    const std::string host = target.substr(begin, end - begin);
    if (host.empty() || !is_authority(host)) return problem(400, "The target of the request names no host.");
    request.target = target.substr(end);
    if (!request.target.starts_with('/')) request.target.insert(0, "/");
    request.headers.set("Host", host);
    return std::nullopt;
}

}  // namespace

std::optional<Response> check_head(Request& request, unsigned version) {
    if (version / 10 != 1) return problem(505, "Only HTTP/1.0 and HTTP/1.1 are spoken here.");
    if (auto wrong = check_host(request, version)) return wrong;
    if (auto wrong = check_transfer_encoding(request, version)) return wrong;
    return check_target(request);
}

}  // namespace sheer::http
