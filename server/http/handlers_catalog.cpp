#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "embedded_specs.h"
#include "renderer/errors.h"
#include "renderer/report/report.h"
#include "renderer/spec/spec.h"
#include "renderer/spec/suites.h"
#include "server/http/problem.h"
#include "server/http/service.h"

namespace sheer::http {

using nlohmann::json;

namespace {

Route catalog_route(std::string path, std::string id, std::string summary, Handler handle) {
    return {.method = "GET",
            .pattern = std::move(path),
            .id = std::move(id),
            .summary = std::move(summary),
            .replies = {{200, "The list", "application/json", "Catalog"}},
            .handle = std::move(handle)};
}

/// Answers with a text that stays the same as long as the program runs.
Handler fixed_json(const json& body) {
    Response response = json_response(200, body);
    response.headers.add("ETag", fmt::format("\"{}\"", sha256_hex(std::get<std::string>(response.body)).substr(0, 32)));
    response.headers.add("Cache-Control", "no-cache");
    return [response](const Request&) { return response; };
}

/// The specs of configs/specs that can be posted as they are; one that refers to a file beside it cannot.
json describe_examples() {
    const AssetRule no_files = [](const AssetReference&) { return "is a file"; };
    json examples = json::array();
    for (const EmbeddedFile& file : embedded_specs()) {
        const json spec = json::parse(file.bytes);
        try {
            parse_spec(spec, no_files);
        } catch (const SpecError&) {
            continue;
        }
        examples.push_back({{"id", file.path.substr(0, file.path.rfind('.'))}, {"spec", spec}});
    }
    return examples;
}

Answer get_devices(Service& service) {
    try {
        return json_response(200, service.list_devices());
    } catch (const std::exception& error) {
        spdlog::error("the devices cannot be listed: {}", error.what());
        throw Problem(503, "The devices cannot be listed now; the service's log says why.").with("Retry-After", "10");
    }
}

}  // namespace

std::vector<Route> catalog_routes(Service& service) {
    return {
        catalog_route("/api/v1/methods", "listMethods", "The methods with their parameters",
                      fixed_json(describe_methods())),
        catalog_route("/api/v1/scenes", "listScenes", "The scene types with their parameters",
                      fixed_json(describe_scenes())),
        catalog_route("/api/v1/metrics", "listMetrics", "The metrics with their fields",
                      fixed_json(describe_metrics())),
        catalog_route("/api/v1/suites", "listSuites", "Published measurements that can be repeated: post their spec",
                      fixed_json(describe_suites())),
        catalog_route("/api/v1/specs/fields", "listSpecFields",
                      "The fields of a spec; what scenes and methods have is described with them",
                      fixed_json(describe_spec_fields())),
        catalog_route("/api/v1/specs/examples", "listExamples", "Ready specs to start from: post them",
                      fixed_json(describe_examples())),
        catalog_route("/api/v1/devices", "listDevices", "The devices that can render",
                      [&service](const Request&) { return get_devices(service); })};
}

}  // namespace sheer::http
