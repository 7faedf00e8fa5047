#include "server/http/problem.h"
#include "server/http/service.h"

namespace sheer::http {

std::vector<Route> metrics_routes(Service& service) {
    return {{.method = "GET", .pattern = "/metrics", .handle = [&service](const Request&) {
                 if (!service.metrics) throw Problem(404, "There are no metrics.");
                 return text_response(200, service.metrics(), "text/plain; version=0.0.4; charset=utf-8");
             }}};
}

}  // namespace sheer::http
