#include "server/http/problem.h"
#include "server/http/service.h"

namespace sheer::http {

namespace {

Answer get_ready(Service& service) {
    const auto last_ms = service.store.last_rendered_ms();
    const std::int64_t age_ms = last_ms ? service.clock() - *last_ms : -1;
    if (!last_ms || age_ms > std::chrono::milliseconds(service.ready_within).count())
        throw Problem(503, "No worker rendered anything lately.").with("Retry-After", "5");
    return json_response(200, {{"status", "ready"}, {"last_rendered_at", utc_text(*last_ms)}});
}

Route health_route(std::string path, std::string id, std::string summary, std::vector<Reply> replies, Handler handle) {
    return {.method = "GET",
            .pattern = std::move(path),
            .id = std::move(id),
            .summary = std::move(summary),
            .replies = std::move(replies),
            .handle = std::move(handle)};
}

}  // namespace

std::vector<Route> health_routes(Service& service) {
    return {health_route("/healthz", "getHealth", "Whether the service is alive",
                         {{200, "It is", "application/json", "Health"}},
                         [](const Request&) {
                             return json_response(200, {{"status", "ok"}});
                         }),
            health_route("/readyz", "getReadiness", "Whether a worker rendered something lately",
                         {{200, "One did", "application/json", "Health"},
                          {503, "None did", "application/problem+json", "Problem"}},
                         [&service](const Request&) { return get_ready(service); })};
}

}  // namespace sheer::http
