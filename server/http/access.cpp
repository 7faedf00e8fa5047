#include "server/http/access.h"

#include <fmt/format.h>

#include <boost/beast/core/string.hpp>

#include "server/http/problem.h"
#include "server/http/text.h"

namespace sheer::http {

namespace {

/// The value of a cookie (RFC 6265, 4.2); "" if it is not sent.
std::string cookie_in(const Request& request, std::string_view name) {
    const std::string cookies = request.headers.find("Cookie").value_or("");
    for (std::size_t begin = 0; begin < cookies.size();) {
        const std::size_t end = std::min(cookies.find(';', begin), cookies.size());
        const std::string_view pair = trimmed(std::string_view(cookies).substr(begin, end - begin));
        if (const std::size_t equals = pair.find('=');
            equals != std::string_view::npos && pair.substr(0, equals) == name)
            return std::string(pair.substr(equals + 1));
        begin = end + 1;
    }
    return "";
}

}  // namespace

std::string secret_in(const Request& request) {
    const std::string authorization = request.headers.find("Authorization").value_or("");
    constexpr std::string_view scheme = "Bearer ";
    if (boost::beast::iequals(std::string_view(authorization).substr(0, scheme.size()), scheme))
        return std::string(trimmed(std::string_view(authorization).substr(scheme.size())));
    return cookie_in(request, session_cookie);
}

std::optional<Token> Access::token_of(const Request& request) const {
    const std::string secret = secret_in(request);
    return secret.empty() ? std::nullopt : find(secret);
}

std::optional<Token> Access::find(const std::string& secret) const {
    return m_tokens == nullptr ? std::nullopt : m_tokens->find(secret);
}

std::optional<Response> Access::refusal(const Request& request, Scope needed) const {
    if (needed == Scope::none || !is_required()) return std::nullopt;
    const auto token = token_of(request);
    if (token && token->scope >= needed) return std::nullopt;
    if (!token) {
        const bool is_wrong = !secret_in(request).empty();
        Response response = problem(401, is_wrong ? "The service does not know this token."
                                                  : "The service asks for a token: Authorization: Bearer TOKEN.");
        response.headers.add("WWW-Authenticate",
                             is_wrong ? "Bearer realm=\"sheer\", error=\"invalid_token\"" : "Bearer realm=\"sheer\"");
        return response;
    }
    Response response = problem(403, fmt::format("This takes a token with the scope {}; \"{}\" has the scope {}.",
                                                 scope_text(needed), token->name, scope_text(token->scope)));
    response.headers.add(
        "WWW-Authenticate",
        fmt::format("Bearer realm=\"sheer\", error=\"insufficient_scope\", scope=\"{}\"", scope_text(needed)));
    return response;
}

}  // namespace sheer::http
