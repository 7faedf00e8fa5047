#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "embedded_specs.h"
#include "embedded_web.h"
#include "renderer/core/errors.h"
#include "renderer/report/statistics.h"
#include "renderer/results/quantity.h"
#include "renderer/spec/catalog.h"
#include "renderer/spec/spec.h"
#include "renderer/spec/spec_fields.h"
#include "renderer/spec/suites.h"
#include "server/http/problem.h"
#include "server/http/service.h"

namespace sheer::http {

using nlohmann::json;

namespace {

Route catalog_route(std::string path, std::string id, std::string summary, std::string schema, Handler handle) {
    return {.method = "GET",
            .pattern = std::move(path),
            .id = std::move(id),
            .summary = std::move(summary),
            .replies = {{200, "The list", "application/json", std::move(schema), {"ETag"}}},
            .handle = std::move(handle)};
}

Handler fixed_json(const json& body) {
    return always(json_response(200, body));
}

constexpr std::string_view spec_ending = ".json";
constexpr const char* spec_files_path = "/api/v1/specs/files";

/// Null if there is none.
const EmbeddedFile* find_file(std::span<const EmbeddedFile> files, std::string_view path) {
    const auto found = std::ranges::find(files, path, &EmbeddedFile::path);
    return found == files.end() ? nullptr : &*found;
}
const EmbeddedFile* find_spec_file(std::string_view name) {
    return find_file(embedded_specs(), name);
}

/// The specs of configs/specs, each with the files that it needs and the sentence of the text file of the same name.
json describe_examples() {
    std::vector<catalog::Example> examples;
    for (const EmbeddedFile& file : embedded_specs()) {
        if (!file.path.ends_with(spec_ending)) continue;
        catalog::Example example{.id = std::string(file.path.substr(0, file.path.size() - spec_ending.size())),
                                 .spec = json::parse(file.bytes)};
        if (const EmbeddedFile* text = find_spec_file(example.id + ".txt"))
            example.teaches = text->bytes.substr(0, text->bytes.find_last_not_of('\n') + 1);
        const std::string picture = fmt::format("thumbnails/specs/{}.jpg", example.id);
        if (find_file(embedded_web(), picture)) example.picture = "/" + picture;
        parse_spec(example.spec, [&example](const AssetReference& asset) {
            if (!find_spec_file(asset.name)) return "is a file that this program does not contain";
            example.files.push_back({asset.pointer, asset.name, fmt::format("{}/{}", spec_files_path, asset.name)});
            return "";
        });
        examples.push_back(std::move(example));
    }
    return to_document(examples);
}

/// For each number of methods that a spec can have, from 1 on.
std::vector<std::uint64_t> rounds_by_methods() {
    std::vector<std::uint64_t> needed;
    for (std::size_t methods = 1; methods <= max_methods; ++methods)
        needed.push_back(rounds_needed(std::max<std::size_t>(methods - 1, 1)));
    return needed;
}

Answer get_spec_file(const Request& request) {
    const EmbeddedFile* file = find_spec_file(request.path_values.at("name"));
    if (!file || file->path.ends_with(spec_ending)) throw Problem(404, "There is no such file.");
    return text_response(200, std::string(file->bytes), "application/octet-stream");
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
        catalog_route("/api/v1/methods", "listMethods", "The methods with their parameters", "MethodList",
                      fixed_json(describe_methods())),
        catalog_route("/api/v1/scenes", "listScenes", "The scene types with their parameters", "SceneList",
                      fixed_json(describe_scenes())),
        catalog_route("/api/v1/metrics", "listMetrics", "The metrics with their fields", "MetricList",
                      fixed_json(describe_metrics())),
        catalog_route("/api/v1/columns", "listColumns", "The columns of the tables of times and fragments",
                      "ColumnList", fixed_json(to_document(time_and_fragment_columns()))),
        catalog_route("/api/v1/rounds", "listRoundsNeeded",
                      "The rounds that intervals of speedups need, by the number of methods", "RoundsNeeded",
                      fixed_json(to_document(rounds_by_methods()))),
        catalog_route("/api/v1/suites", "listSuites", "Published measurements that can be repeated: post their spec",
                      "SuiteList", fixed_json(describe_suites())),
        catalog_route("/api/v1/specs/fields", "listSpecFields",
                      "The fields of a spec, except those of scenes and methods", "FieldList",
                      fixed_json(describe_spec_fields())),
        catalog_route("/api/v1/specs/examples", "listExamples", "Ready-made specs to start from: post them",
                      "ExampleList", fixed_json(describe_examples())),
        {.method = "GET",
         .pattern = std::string(spec_files_path) + "/{name}",
         .id = "getSpecFile",
         .summary = "A file to which a ready-made spec refers",
         .replies = {{200, "The file", "application/octet-stream", ""},
                     {404, "There is no such file", "application/problem+json", "Problem"}},
         .handle = get_spec_file},
        catalog_route("/api/v1/devices", "listDevices", "The devices that can render", "DeviceList",
                      [&service](const Request&) { return get_devices(service); })};
}

}  // namespace sheer::http
