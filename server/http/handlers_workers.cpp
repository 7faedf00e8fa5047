#include "renderer/core/clock.h"
#include "server/http/answers.h"
#include "server/http/service.h"

namespace sheer::http {

namespace {

Answer get_workers(Service& service) {
    answer::WorkerList list;
    for (const SeenWorker& worker : service.store.workers().list(in_sight_ms(service)))
        list.workers.push_back({worker.name, worker.label, worker.driver, utc_text(worker.seen_ms), worker.job});
    return json_response(200, to_document(list));
}

}  // namespace

std::int64_t in_sight_ms(const Service& service) {
    return std::chrono::milliseconds(service.limits.ready_within).count();
}

std::vector<Route> worker_routes(Service& service) {
    return {{.method = "GET",
             .pattern = "/api/v1/workers",
             .id = "listWorkers",
             .summary = "The workers of this service's store, on all machines",
             .description = "Those that were seen within `http.ready_within_s`.",
             .replies = {{200, "The list", "application/json", "WorkerList"}},
             .handle = [&service](const Request&) { return get_workers(service); }}};
}

}  // namespace sheer::http
