#include "server/http/application.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "renderer/params/json_text.h"
#include "server/http/negotiation.h"
#include "server/http/preconditions.h"
#include "server/http/problem.h"
#include "server/http/text.h"
#include "server/jobs/store_errors.h"

namespace sheer::http {

using nlohmann::json;

namespace {

void add_default(Headers& headers, const char* name, const char* value) {
    if (!headers.contains(name)) headers.add(name, value);
}

Response try_again(const std::string& detail) {
    Response response = problem(503, detail);
    response.headers.add("Retry-After", "5");
    return response;
}

/// The result of `work`, or the problem with which it ends.
template <typename Result, typename Work>
Result caught(const Request& request, const Work& work) {
    try {
        return work();
    } catch (const Problem& wrong) {
        return wrong.response();
    } catch (const SpecError& wrong) {
        return problem(422, "The spec is wrong.", wrong.errors(), wrong.count());
    } catch (const StoreFull& full) {
        spdlog::error("{} {}: {}", request.method, request.target, full.what());
        return problem(507, fmt::format("There is no room: {}.", full.what()));
    } catch (const StoreUnreachable& lost) {
        spdlog::error("{} {}: {}", request.method, request.target, lost.what());
        return try_again("The store cannot be reached at present.");
    } catch (const DiskError& failed) {
        spdlog::error("{} {}: {}", request.method, request.target, failed.what());
        return try_again("The disk of the store failed; the service's log says how.");
    } catch (const DamagedData& damaged) {
        spdlog::error("{} {}: {}", request.method, request.target, damaged.what());
        return problem(500, fmt::format("The archive is damaged: {}.", damaged.what()));
    } catch (const std::exception& error) {
        spdlog::error("{} {}: {}", request.method, request.target, error.what());
        return problem(500, "The service failed to answer; its log says why.");
    }
}

/// JSON may come without a type. Other bodies may not, since their type says how to read them.
void check_body_type(const Route& route, const std::optional<std::string>& content_type) {
    const bool json_expected = !route.body_schema.empty();
    if (json_expected && (!content_type || is_json_type(*content_type))) return;
    const std::string type = media_type_of(content_type.value_or(""));
    if (!json_expected &&
        (route.body_types.empty() || std::ranges::find(route.body_types, type) != route.body_types.end()))
        return;
    const std::string wanted =
        json_expected ? "application/json" : fmt::format("{}", fmt::join(route.body_types, ", "));
    throw Problem(415, fmt::format("The body must have the type {}{}.", wanted,
                                   content_type ? ", not " + *content_type : "; Content-Type is missing"))
        .with("Accept", wanted);
}

/// For a request that changes nothing, the same response; 304 if its sender has it already, 412 if If-Match is not
/// satisfied. `etag` is that of the uncompressed body.
Response unless_known(Response response, const Request& request, const std::string& etag) {
    if (response.status != 200 || !is_safe(request.method)) return response;
    switch (judge_preconditions(request, etag)) {
        case Precondition::met:
            break;
        case Precondition::not_modified:
            response.status = 304;
            response.body = std::string();
            break;
        case Precondition::failed:
            return problem(412, "If-Match is not satisfied.");
    }
    return response;
}

/// Who asked for what, whatever comes of it: the access log has the outcome.
void log_change(const std::optional<Token>& token, const Request& request) {
    if (token)
        spdlog::info("audit: \"{}\" ({}) {} {}", token->name, scope_text(token->scope), request.method, request.target);
}

void check_body_coding(const Request& request) {
    const auto coding = request.headers.joined("Content-Encoding");
    if (coding && *coding != "identity")
        throw Problem(415, fmt::format("The body must not be compressed, as it is with {}.", *coding))
            .with("Accept-Encoding", "identity");
}

/// Errors are problems, whatever Accept says.
void check_accept(const Route& route, const Request& request) {
    const auto accept = request.headers.joined("Accept");
    if (!accept) return;
    std::vector<std::string> types;
    for (const Reply& reply : route.replies)
        if (reply.status < 300 && !reply.media_type.empty()) types.push_back(reply.media_type);
    const auto is_accepted = [&](const std::string& type) { return accepts(accept, type); };
    if (types.empty() || std::ranges::any_of(types, is_accepted)) return;
    throw Problem(406, fmt::format("There is no such form of this, only {}.", types.front()));
}

}  // namespace

std::string Application::pattern_of(std::string_view method, std::string_view target) const {
    const Match match = m_router.match(method, target.substr(0, target.find('?')));
    return match.route == nullptr ? "" : match.route->pattern;
}

Handling Application::handling(std::string_view method, std::string_view target) const {
    target = m_prefix.stripped(target);
    const Match match = m_router.match(method, target.substr(0, target.find('?')));
    if (match.route == nullptr) return {};
    Handling handling{
        .lane = match.route->lane, .is_probe = match.route->is_probe, .may_be_known = match.route->known != nullptr};
    if (match.route->body_bytes != 0) handling.body_bytes = match.route->body_bytes;
    return handling;
}

Response Application::prepared(Response response, const Request& request) const {
    const std::string etag = response.headers.find("ETag").value_or("");
    response = m_prefix.put_before(std::move(response));
    choose_coding(response, request);
    m_guard.permit(request, response.headers);
    return finished(unless_known(std::move(response), request, etag));
}

Response Application::sent(Response response, const Request& request) const {
    return encoded(prepared(std::move(response), request), request.target, *m_packed);
}

std::optional<Response> Application::known(Request request) const {
    request.target = std::string(m_prefix.stripped(request.target));
    request = without_coding(std::move(request));
    auto response = caught<std::optional<Response>>(request, [&]() -> std::optional<Response> {
        auto found = admitted(request);
        if (auto* refusal = std::get_if<Response>(&found)) return std::move(*refusal);
        return std::get<const Route*>(found)->known(request);
    });
    if (!response) return std::nullopt;
    return encoded_if_known(prepared(std::move(*response), request), request.target, *m_packed);
}

Answer Application::answer(Request request) const {
    if (auto redirection = m_prefix.redirection(request.target)) return finished(std::move(*redirection));
    request.target = std::string(m_prefix.stripped(request.target));
    request = without_coding(std::move(request));
    Answer answer = caught<Answer>(request, [&] { return handle(request); });
    if (auto* response = std::get_if<Response>(&answer)) return sent(std::move(*response), request);
    if (auto* stream = std::get_if<EventStream>(&answer)) {
        m_guard.permit(request, stream->head.headers);
        stream->head = finished(std::move(stream->head));
    }
    if (auto* waiting = std::get_if<Waiting>(&answer)) {
        waiting->ready = [this, ready = std::move(waiting->ready), request]() -> std::optional<Response> {
            auto response = caught<std::optional<Response>>(request, ready);
            if (response) response = sent(std::move(*response), request);
            return response;
        };
        waiting->otherwise = [this, otherwise = std::move(waiting->otherwise), request] {
            return sent(caught<Response>(request, otherwise), request);
        };
    }
    return answer;
}

std::variant<const Route*, Response> Application::admitted(Request& request) const {
    const std::string_view target = request.target;
    const std::size_t question = target.find('?');
    Match match = m_router.match(request.method, target.substr(0, question));
    if (match.route == nullptr || !match.route->is_probe)
        if (auto refusal = m_guard.refusal(request)) return *refusal;
    if (match.allowed.empty()) throw Problem(404, "There is nothing at this address.");
    const auto allow = [&match] { return fmt::format("{}", fmt::join(match.allowed, ", ")); };
    if (request.method == "OPTIONS") {
        Response response{.status = 204, .headers = {}, .body = {}};
        response.headers.add("Allow", allow());
        return response;
    }
    if (!match.route)
        throw Problem(405, fmt::format("{} is not allowed here; allowed are {}.", request.method, allow()))
            .with("Allow", allow());
    if (auto refusal = m_access.refusal(request, match.route->needed_scope())) return *refusal;
    if (!is_safe(request.method)) log_change(m_access.token_of(request), request);
    request.path_values = std::move(match.path_values);
    request.query = read_query(question == std::string_view::npos ? "" : target.substr(question + 1),
                               match.route->query, match.route->wrong_query_status, match.route->repeatable);
    check_accept(*match.route, request);
    check_body_coding(request);
    check_body_type(*match.route, request.headers.find("Content-Type"));
    if (!is_safe(request.method) &&
        judge_preconditions(request, match.route->etag ? match.route->etag(request) : "") != Precondition::met)
        throw Problem(412, "If-Match or If-None-Match is not satisfied; nothing was done.");
    return match.route;
}

Answer Application::handle(Request& request) const {
    auto found = admitted(request);
    if (auto* response = std::get_if<Response>(&found)) return std::move(*response);
    return std::get<const Route*>(found)->handle(request);
}

Response finished(Response response) {
    add_default(response.headers, "Content-Security-Policy", "default-src 'none'; frame-ancestors 'none'; sandbox");
    add_default(response.headers, "X-Content-Type-Options", "nosniff");
    add_default(response.headers, "Referrer-Policy", "no-referrer");
    // Otherwise any page could show the pictures of a service on loopback.
    add_default(response.headers, "Cross-Origin-Resource-Policy", "same-origin");
    add_default(response.headers, "Cache-Control", "no-store");
    return response;
}

json json_body(const Request& request) {
    try {
        return read_json(request.body);
    } catch (const NotJson& error) {
        throw Problem(400, fmt::format("The body is not JSON: {}.", error.what()));
    }
}

}  // namespace sheer::http
