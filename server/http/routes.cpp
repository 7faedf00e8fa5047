#include "server/http/service.h"

namespace sheer::http {

namespace {

struct Topic {
    Tag tag;
    std::vector<Route> (*routes)(Service& service);
};

std::vector<Topic> all_topics() {
    return {
        {{"Submit", "Check specs, and queue comparisons"}, submit_routes},
        {{"Report", "One report, in the forms that programs and people read"}, report_routes},
        {{"Early", "Pictures of a report that is not done"}, early_routes},
        {{"Diff", "Two reports compared with each other"}, diff_routes},
        {{"Pixel", "One pixel of a report"}, pixel_routes},
        {{"Archive", "The list of reports, and their pictures"}, archive_routes},
        {{"Assets", "Uploaded textures, models and volumes"}, asset_routes},
        {{"Baselines", "Accepted reports, with which others are compared"}, baseline_routes},
        {{"Pins", "Reports that are never deleted or pruned"}, pin_routes},
        {{"Trends", "A number of the reports of one spec over time"}, trend_routes},
        {{"Catalog", "What this service offers: methods, scenes, metrics, ready-made specs, devices"}, catalog_routes},
        {{"Session", "The token of a browser"}, session_routes},
        {{"Workers", "The processes that render"}, worker_routes},
        {{"Health", "For probes"}, health_routes}};
}

}  // namespace

Router make_router(Service& service) {
    Router router;
    std::vector<Tag> tags;
    for (const Topic& topic : all_topics()) {
        std::vector<Route> routes = topic.routes(service);
        for (Route& route : routes) route.tag = topic.tag.name;
        router.add(std::move(routes));
        tags.push_back(topic.tag);
    }
    router.add(metrics_routes(service));
    Route openapi{.method = "GET",
                  .pattern = "/api/v1/openapi.json",
                  .id = "getOpenapi",
                  .summary = "This document",
                  .description = "It is made from the table that answers the requests. `/api.html` shows it.",
                  .replies = {{200, "The document", "application/json", "OpenapiDocument", {"ETag"}}},
                  .handle = {},
                  .tag = "Catalog",
                  .scope = Scope::none};
    std::vector<Route> documented = router.routes();
    documented.push_back(openapi);
    openapi.handle = always(json_response(200, openapi_document(documented, tags, service.path_prefix)));
    router.add({std::move(openapi)});
    router.add(page_routes());
    return router;
}

}  // namespace sheer::http
