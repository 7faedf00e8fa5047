#include <fmt/format.h>

#include <algorithm>

#include "renderer/spec/spec.h"
#include "server/http/problem.h"
#include "server/http/service.h"
#include "server/http/text.h"
#include "server/jobs/status.h"
#include "version.h"

namespace sheer::http {

using nlohmann::json;

namespace {

json reference(const std::string& schema) {
    return {{"$ref", "#/components/schemas/" + schema}};
}

json content(const std::string& media_type, const std::string& schema) {
    return {{media_type, {{"schema", schema.empty() ? json::object() : reference(schema)}}}};
}

json error_reply(const char* description) {
    return {{"description", description}, {"content", content("application/problem+json", "Problem")}};
}

/// The names between braces.
std::vector<std::string> path_names(const std::string& pattern) {
    std::vector<std::string> names;
    for (const std::string_view part : split(pattern, '/'))
        if (part.starts_with('{')) names.emplace_back(part.substr(1, part.size() - 2));
    return names;
}

json parameters_of(const Route& route) {
    json parameters = json::array();
    for (const std::string& name : path_names(route.pattern))
        parameters.push_back({{"name", name}, {"in", "path"}, {"required", true}, {"schema", {{"type", "string"}}}});
    const json fields = schema_of(route.query);
    const json required = fields.value("required", json::array());
    for (const Param& param : route.query)
        parameters.push_back({{"name", param.name},
                              {"in", "query"},
                              {"description", param.summary},
                              {"required", std::ranges::find(required, json(param.name)) != required.end()},
                              {"schema", fields["properties"][param.name]}});
    for (const HeaderField& header : route.headers)
        parameters.push_back({{"name", header.name},
                              {"in", "header"},
                              {"description", header.summary},
                              {"schema", {{"type", "string"}}}});
    return parameters;
}

json request_body(const Route& route) {
    json types = json::object();
    if (!route.body_schema.empty()) types = content("application/json", route.body_schema);
    for (const std::string& type : route.body_types) types[type] = {{"schema", json::object()}};
    return {{"required", true}, {"content", types}};
}

json operation_of(const Route& route) {
    json operation = {{"operationId", route.id}, {"summary", route.summary}, {"responses", json::object()}};
    if (json parameters = parameters_of(route); !parameters.empty()) operation["parameters"] = parameters;
    json& responses = operation["responses"];
    for (const Reply& reply : route.replies) {
        json& response = responses[std::to_string(reply.status)];
        response["description"] = reply.description;
        if (!reply.media_type.empty()) response["content"] = content(reply.media_type, reply.schema);
    }
    if (!route.query.empty())
        responses["400"] =
            error_reply(route.wrong_query_status == 400 ? "The query is wrong" : "The query cannot be read");
    if (!route.body_schema.empty() || !route.body_types.empty()) {
        operation["requestBody"] = request_body(route);
        if (!route.body_schema.empty()) responses["400"] = error_reply("The body is not JSON");
        responses["413"] = error_reply("The body is too long");
        responses["415"] = error_reply("The body has another type");
    }
    responses["default"] = error_reply("What is wrong");
    return operation;
}

json object_schema(json properties, json required) {
    return {{"type", "object"}, {"properties", std::move(properties)}, {"required", std::move(required)}};
}

json text_schema() {
    return {{"type", "string"}};
}
json nullable(const char* type) {
    return {{"type", {type, "null"}}};
}

json status_schema() {
    json names = json::array();
    for (const Status status : {Status::queued, Status::running, Status::done, Status::failed, Status::cancelled})
        names.push_back(status_text(status));
    return {{"type", "string"}, {"enum", names}};
}

/// What a report and its line in the list have in common.
json common_properties() {
    json error = object_schema({{"title", text_schema()}, {"detail", text_schema()}}, {"title", "detail"});
    error["type"] = {"object", "null"};
    return {{"id", text_schema()},
            {"status", status_schema()},
            {"progress", {{"type", "number"}, {"minimum", 0}, {"maximum", 1}}},
            {"error", error},
            {"created_at", {{"type", "string"}, {"format", "date-time"}}},
            {"finished_at", {{"type", {"string", "null"}}, {"format", "date-time"}}},
            {"spec_sha256", text_schema()}};
}

json report_schema() {
    json properties = common_properties();
    properties["stage"] = {{"type", "string"},
                           {"description", "what the renderer is at; only until the report is done"}};
    properties["spec"] = reference("Spec");
    for (const char* name : {"device", "color_space", "provenance"}) properties[name] = {{"type", "object"}};
    for (const char* name : {"runs", "checks"}) properties[name] = {{"type", "array"}, {"items", {{"type", "object"}}}};
    properties["verdict"] = {{"enum", {"passed", "failed", "undecided", "none"}}};
    json file = object_schema({{"pointer", text_schema()},
                               {"name", text_schema()},
                               {"of", nullable("string")},
                               {"sha256", text_schema()},
                               {"bytes", {{"type", "integer"}}}},
                              {"pointer", "name", "of", "sha256", "bytes"});
    properties["files"] = {{"type", "array"}, {"items", file}, {"description", "every file that the report drew from"}};
    properties["verdict_reason"] = nullable("string");
    return object_schema(properties, {"id", "status", "progress", "error", "created_at", "spec", "spec_sha256"});
}

json list_schema() {
    json properties = common_properties();
    for (const char* name : {"url", "title", "scene"}) properties[name] = text_schema();
    properties["tags"] = {{"type", "object"}, {"additionalProperties", text_schema()}};
    properties["methods"] = {{"type", "array"}, {"items", text_schema()}};
    properties["verdict"] = nullable("string");
    properties["preview"] = nullable("object");
    properties["broken"] = {{"type", "string"}, {"description", "what of it cannot be read any more"}};
    const json line = object_schema(properties, {"id", "url", "status", "progress", "created_at", "title"});
    return object_schema({{"reports", {{"type", "array"}, {"items", line}}}, {"next_cursor", nullable("string")}},
                         {"reports", "next_cursor"});
}

json color_schema() {
    return {{"type", "array"}, {"items", nullable("number")}, {"minItems", 3}, {"maxItems", 3}};
}

/// See renderer/files/pixel.h.
json pixel_schema() {
    const json number = {{"type", "number"}}, count = nullable("integer");
    json color_or_null = color_schema();
    color_or_null["type"] = {"array", "null"};
    const json fragment = object_schema({{"depth", number},
                                         {"color", color_schema()},
                                         {"alpha", number},
                                         {"primitive", {{"type", "integer"}}},
                                         {"transmittance_before", number},
                                         {"weight", number}},
                                        {"depth", "color", "alpha", "primitive", "transmittance_before", "weight"});
    json opaque = object_schema({{"depth", number}, {"color", color_schema()}}, {"depth", "color"});
    opaque["type"] = {"object", "null"};
    const json fact = object_schema(
        {{"name", text_schema()},
         {"kind", {{"enum", {"number", "color", "fragment", "fragments", "samples"}}}},
         {"value", {{"description", "by its kind; a fragment is its place in `fragments`, from 1, or null for none"}}},
         {"text", text_schema()}},
        {"name", "kind", "value", "text"});
    const json facts = {{"type", {"array", "null"}},
                        {"description", "what the method made of the pixel, in its own terms"},
                        {"items", fact}};
    json method = object_schema(
        {{"method", text_schema()},
         {"label", text_schema()},
         {"status", text_schema()},
         {"reason", nullable("string")},
         {"value", color_or_null},
         {"difference", color_or_null},
         {"shaded", count},
         {"needed", count},
         {"saturated_at", count},
         {"explanation", facts},
         {"explained_value", color_schema()},
         {"explanation_reason", text_schema()}},
        {"method", "label", "status", "value", "difference", "shaded", "needed", "saturated_at", "explanation"});
    method["description"] = "a count that is not known is null, and <name>_reason says why";
    return object_schema(
        {{"x", {{"type", "integer"}}},
         {"y", {{"type", "integer"}}},
         {"point", {{"type", "object"}}},
         {"background", color_schema()},
         {"opaque", opaque},
         {"fragments", {{"type", "array"}, {"items", fragment}}},
         {"transmittance", number},
         {"sum", color_schema()},
         {"reference", {{"type", "object"}}},
         {"methods", {{"type", "array"}, {"items", method}}}},
        {"x", "y", "background", "opaque", "fragments", "transmittance", "sum", "reference", "methods"});
}

json asset_schema() {
    json properties = {{"bytes", {{"type", "integer"}}}, {"created_at", {{"type", "string"}, {"format", "date-time"}}}};
    for (const char* name : {"sha256", "type", "media_type", "name", "url"}) properties[name] = text_schema();
    properties["broken"] = {{"type", "string"}, {"description", "what of it is not there any more"}};
    json schema = object_schema(properties, {"sha256", "type", "media_type", "name", "bytes", "created_at", "url"});
    schema["description"] = "and what the check of its kind found, such as width and height of a picture";
    return schema;
}

json asset_list_schema() {
    const json texts = {{"type", "array"}, {"items", text_schema()}};
    const json kind = object_schema({{"media_type", text_schema()}, {"type", text_schema()}, {"suffixes", texts}},
                                    {"media_type", "type", "suffixes"});
    return object_schema({{"assets", {{"type", "array"}, {"items", reference("Asset")}}},
                          {"accepts", {{"type", "array"}, {"items", kind}}},
                          {"max_bytes", {{"type", "integer"}}}},
                         {"assets", "accepts", "max_bytes"});
}

json diff_schema() {
    const json objects = {{"type", "array"}, {"items", {{"type", "object"}}}};
    const json object = {{"type", "object"}};
    return object_schema({{"a", object},
                          {"b", object},
                          {"same_device", {{"type", "boolean"}}},
                          {"differences", objects},
                          {"only_in", object},
                          {"summary", object},
                          {"runs", objects}},
                         {"a", "b", "same_device", "differences", "only_in", "summary", "runs"});
}

json problem_schema() {
    const json error = object_schema({{"pointer", text_schema()}, {"detail", text_schema()}}, {"pointer", "detail"});
    return object_schema({{"type", text_schema()},
                          {"title", text_schema()},
                          {"status", {{"type", "integer"}}},
                          {"detail", text_schema()},
                          {"errors", {{"type", "array"}, {"maxItems", max_told_errors}, {"items", error}}},
                          {"error_count", {{"type", "integer"}, {"description", "of all errors, told or not"}}}},
                         {"type", "title", "status", "detail"});
}

json schemas() {
    json spec = spec_schema();
    spec.erase("$schema");
    return {{"Spec", spec},
            {"Report", report_schema()},
            {"ReportList", list_schema()},
            {"Pixel", pixel_schema()},
            {"Asset", asset_schema()},
            {"AssetList", asset_list_schema()},
            {"Diff", diff_schema()},
            {"Problem", problem_schema()},
            {"Catalog", {{"type", "array"}, {"items", {{"type", "object"}}}}},
            {"Health", object_schema({{"status", text_schema()}}, {"status"})}};
}

}  // namespace

json openapi_document(const std::vector<Route>& routes) {
    json paths = json::object();
    for (const Route& route : routes) {
        if (route.id.empty()) continue;
        std::string method = route.method;
        std::ranges::transform(method, method.begin(), [](unsigned char c) { return std::tolower(c); });
        paths[route.pattern][method] = operation_of(route);
    }
    return {{"openapi", "3.1.0"},
            {"info", {{"title", "Sheer"}, {"version", version}, {"summary", "Compares transparency methods"}}},
            {"paths", paths},
            {"components", {{"schemas", schemas()}}}};
}

Router make_router(Service& service) {
    Router router;
    for (auto* routes : {submit_routes, report_routes, diff_routes, pixel_routes, archive_routes, asset_routes,
                         catalog_routes, health_routes})
        router.add(routes(service));
    Route openapi{.method = "GET",
                  .pattern = "/api/v1/openapi.json",
                  .id = "getOpenapi",
                  .summary = "This document",
                  .replies = {{200, "The document", "application/json", ""}},
                  .handle = {}};
    std::vector<Route> documented = router.routes();
    documented.push_back(openapi);
    openapi.handle = [response = json_response(200, openapi_document(documented))](const Request&) { return response; };
    router.add({std::move(openapi)});
    router.add(page_routes());
    return router;
}

}  // namespace sheer::http
