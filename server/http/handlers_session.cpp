#include <fmt/format.h>

#include "server/http/answers.h"
#include "server/http/application.h"
#include "server/http/problem.h"
#include "server/http/quota.h"
#include "server/http/service.h"

namespace sheer::http {

using nlohmann::json;

namespace {

constexpr const char* session_path = "/api/v1/session";
constexpr std::size_t longest_secret_bytes = 1000;

/// What POST takes.
std::vector<Param> session_fields() {
    return {Param::text("token", "the token's secret, which `sheer token create` printed", "", longest_secret_bytes)
                .required()};
}

/// Only for this site, and out of the reach of scripts.
std::string cookie(const Service& service, const std::string& secret, const char* more) {
    return fmt::format("{}={}; Path={}/; HttpOnly; SameSite=Strict{}", session_cookie, secret, service.path_prefix,
                       more);
}

Response get_session(Service& service, const Request& request) {
    answer::Session session{.required = service.access.is_required()};
    if (const auto token = service.access.token_of(request)) {
        session.name = token->name;
        session.scope = scope_text(token->scope);
        session.quotas = quota_lines(service, *token);
    }
    return json_response(200, to_document(session));
}

Response begin_session(const Service& service, const Request& request) {
    std::vector<FieldError> errors;
    const json body = read_fields(json_body(request), "", session_fields(), errors);
    if (!errors.empty()) throw Problem(422, "The session is wrong.", errors);
    const auto secret = body["token"].get<std::string>();
    if (!service.access.find(secret)) throw Problem(401, "The service does not know this token.");
    Response response{.status = 204, .headers = {}, .body = {}};
    response.headers.add("Set-Cookie", cookie(service, secret, ""));
    return response;
}

Response end_session(const Service& service) {
    Response response{.status = 204, .headers = {}, .body = {}};
    response.headers.add("Set-Cookie", cookie(service, "", "; Max-Age=0"));
    return response;
}

Route session_route(std::string method, std::string id, std::string summary, std::vector<Reply> replies,
                    Handler handle) {
    return {.method = std::move(method),
            .pattern = session_path,
            .id = std::move(id),
            .summary = std::move(summary),
            .replies = std::move(replies),
            .handle = std::move(handle),
            .scope = Scope::none};
}

}  // namespace

json session_schema() {
    return schema_of(session_fields());
}

std::vector<Route> session_routes(Service& service) {
    Route begin = session_route("POST", "beginSession", "Keep a token in a cookie, as the page does",
                                {{204, "The cookie is set", "", "", {}},
                                 {401, "There is no such token", "application/problem+json", "Problem"},
                                 {422, "The body is wrong", "application/problem+json", "Problem"}},
                                [&service](const Request& request) { return begin_session(service, request); });
    begin.body_schema = "NewSession";
    return {session_route("GET", "getSession", "Whether the service asks for a token, and what this request's allows",
                          {{200, "Who asks", "application/json", "Session"}},
                          [&service](const Request& request) { return get_session(service, request); }),
            std::move(begin),
            session_route("DELETE", "endSession", "Remove the cookie",
                          {{204, "It is removed", "", ""},
                           {403, "A page of another site asks", "application/problem+json", "Problem"}},
                          [&service](const Request&) { return end_session(service); })};
}

}  // namespace sheer::http
