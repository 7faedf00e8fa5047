#include "server/http/request_head.h"

#include <algorithm>
#include <boost/beast/core/string.hpp>
#include <boost/beast/http/rfc7230.hpp>
#include <boost/url/parse.hpp>

#include "server/http/problem.h"
#include "server/http/text.h"

namespace sheer::http {

namespace bhttp = boost::beast::http;
namespace urls = boost::urls;
using boost::beast::iequals;

namespace {

/// RFC 9110, 5.6.2. `text` has no comma.
bool is_token(std::string_view text) {
    return !text.empty() && bhttp::validate_list(bhttp::opt_token_list(text));
}

/// A name or an address with or without a port.
bool is_host(std::string_view text) {
    const std::string ascii = with_ascii_only(text);
    const auto authority = urls::parse_authority(ascii);
    return authority && !authority->has_userinfo();
}

std::optional<Response> check_host(const Request& request, unsigned version) {
    const std::size_t count = request.headers.count("Host");
    if (count > 1 || (count == 0 && version >= 11))
        return problem(400, "An HTTP/1.1 request must have exactly one Host.");
    if (count == 1 && !is_host(*request.headers.find("Host"))) return problem(400, "This Host is not valid.");
    return std::nullopt;
}

/// The list is parsed here, since Beast's lists ignore empty parts and end silently at the first wrong one: the end of
/// a request must not be guessed.
std::optional<Response> check_transfer_encoding(const Request& request, unsigned version) {
    const auto encoding = request.headers.joined("Transfer-Encoding");
    if (!encoding) return std::nullopt;
    const auto codings = split(*encoding, ',');
    const auto is_chunked = [](std::string_view coding) { return iequals(coding, "chunked"); };
    const bool well_formed =
        std::ranges::all_of(codings,
                            [](std::string_view coding) { return is_token(trimmed(split(coding, ';').front())); }) &&
        std::none_of(codings.begin(), codings.end() - 1, is_chunked);
    if (!well_formed || version < 11) return problem(400, "This Transfer-Encoding is malformed.");
    if (codings.size() == 1 && is_chunked(codings.front())) return std::nullopt;
    return problem(501, "The only supported Transfer-Encoding is chunked.");
}

/// Splits "http://HOST/PATH?QUERY" (RFC 9112, 3.2.2): its host overrides that of the Host field.
std::optional<Response> check_target(Request& request) {
    const std::string target = request.target;
    if (target.starts_with('/') || request.method == "CONNECT" || (request.method == "OPTIONS" && target == "*"))
        return std::nullopt;
    // Without "://" it is not a URL with a host, wherever it is cut.
    const std::size_t host_begin = target.find("://") + 3;
    const std::size_t host_end = std::min(target.find_first_of("/?#", host_begin), target.size());
    const std::string origin = with_ascii_only(target.substr(0, host_end));
    const auto url = urls::parse_uri(origin);
    if (!url || !url->has_authority() ||
        (url->scheme_id() != urls::scheme::http && url->scheme_id() != urls::scheme::https))
        return problem(400, "The target of the request is neither a path nor an http URL.");
    if (url->encoded_host().empty() || url->has_userinfo())
        return problem(400, "The target of the request names no host.");
    request.target = target.substr(host_end);
    if (!request.target.starts_with('/')) request.target.insert(0, "/");
    request.headers.set("Host", target.substr(host_begin, host_end - host_begin));
    return std::nullopt;
}

}  // namespace

std::optional<Response> check_head(Request& request, unsigned version) {
    if (version / 10 != 1) return problem(505, "Only HTTP/1.0 and HTTP/1.1 are supported.");
    if (auto wrong = check_host(request, version)) return wrong;
    if (auto wrong = check_transfer_encoding(request, version)) return wrong;
    return check_target(request);
}

}  // namespace sheer::http
