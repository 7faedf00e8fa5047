#include "server/http/service.h"

namespace sheer::http {

Router make_router(Service& service) {
    Router router;
    for (auto* routes : {submit_routes, report_routes, diff_routes, pixel_routes, archive_routes, asset_routes,
                         baseline_routes, catalog_routes, health_routes})
        router.add(routes(service));
    Route openapi{.method = "GET",
                  .pattern = "/api/v1/openapi.json",
                  .id = "getOpenapi",
                  .summary = "This document",
                  .replies = {{200, "The document", "application/json", "OpenapiDocument"}},
                  .handle = {}};
    std::vector<Route> documented = router.routes();
    documented.push_back(openapi);
    openapi.handle = [response = json_response(200, openapi_document(documented))](const Request&) { return response; };
    router.add({std::move(openapi)});
    router.add(page_routes());
    return router;
}

}  // namespace sheer::http
