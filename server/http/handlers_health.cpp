#include <fmt/format.h>

#include "server/http/answers.h"
#include "server/http/problem.h"
#include "server/http/service.h"

namespace sheer::http {

namespace {

Answer get_ready(Service& service) {
    if (const std::string trouble = service.store.readiness().lack_of_room(); !trouble.empty())
        throw Problem(503, fmt::format("There is no room: {}.", trouble)).with("Retry-After", "30");
    const auto last_ms = service.store.readiness().last_rendered_ms();
    const std::int64_t age_ms = last_ms ? service.clock() - *last_ms : -1;
    if (!last_ms || age_ms > std::chrono::milliseconds(service.limits.ready_within).count())
        throw Problem(503, "No worker has rendered anything recently.").with("Retry-After", "5");
    return json_response(200, to_document(answer::Readiness{{"ready"}, utc_text(*last_ms), service.without_sandbox}));
}

Route health_route(std::string path, std::string id, std::string summary, std::vector<Reply> replies, Lane lane,
                   Handler handle) {
    return {.method = "GET",
            .pattern = std::move(path),
            .id = std::move(id),
            .summary = std::move(summary),
            .replies = std::move(replies),
            .handle = std::move(handle),
            .lane = lane,
            .is_probe = true};
}

}  // namespace

std::vector<Route> health_routes(Service& service) {
    return {
        health_route("/healthz", "getHealth", "Whether the service is alive",
                     {{200, "It is", "application/json", "Health"}}, Lane::at_once,
                     [](const Request&) { return json_response(200, to_document(answer::Health{"ok"})); }),
        health_route("/readyz", "getReadiness",
                     "Whether a worker has rendered something recently, and there is room for reports",
                     {{200, "Both", "application/json", "Readiness"},
                      {503, "`detail` says what is missing", "application/problem+json", "Problem", {"Retry-After"}}},
                     Lane::pool, [&service](const Request&) { return get_ready(service); })};
}

}  // namespace sheer::http
