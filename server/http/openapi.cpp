#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "server/http/components.h"
#include "server/http/service.h"
#include "server/http/text.h"
#include "version.h"

namespace sheer::http {

using nlohmann::json;

namespace {

json reference(const std::string& schema) {
    return {{"$ref", components_prefix + schema}};
}

/// Events are text; `schema` describes the data of each event.
json event_content(const std::string& schema) {
    return {{"text/event-stream", {{"schema", {{"type", "string"}}}, {"x-event-data", reference(schema)}}}};
}

json content(const std::string& media_type, const std::string& schema) {
    if (media_type == "text/event-stream") return event_content(schema);
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
        responses["415"] = error_reply("The type of the body is not accepted");
    }
    responses["default"] = error_reply("An error");
    return operation;
}

/// Otherwise a reference to an unknown component would go unnoticed until a client is generated from the document.
void require_schemas(const Route& route, const std::map<std::string, json>& schemas) {
    const auto require = [&](const std::string& name) {
        if (!name.empty() && !schemas.contains(name))
            throw std::logic_error(fmt::format("{} names an unknown schema: {}", route.id, name));
    };
    require(route.body_schema);
    for (const Reply& reply : route.replies) {
        if (reply.media_type == "application/json" && reply.schema.empty())
            throw std::logic_error(fmt::format("{} answers JSON without a schema", route.id));
        require(reply.schema);
    }
}

}  // namespace

json openapi_document(const std::vector<Route>& routes) {
    const std::map<std::string, json> schemas = component_schemas();
    json paths = json::object();
    for (const Route& route : routes) {
        if (route.id.empty()) continue;
        require_schemas(route, schemas);
        std::string method = route.method;
        std::ranges::transform(method, method.begin(), [](unsigned char c) { return std::tolower(c); });
        paths[route.pattern][method] = operation_of(route);
    }
    return {{"openapi", "3.1.0"},
            {"info", {{"title", "Sheer"}, {"version", version}, {"summary", "Compares transparency methods"}}},
            {"paths", paths},
            {"components", {{"schemas", schemas}}}};
}

}  // namespace sheer::http
