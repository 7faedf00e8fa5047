#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "server/http/components.h"
#include "server/http/openapi_examples.h"
#include "server/http/service.h"
#include "server/http/text.h"
#include "version.h"

namespace sheer::http {

using nlohmann::json;

namespace {

json reference(const std::string& schema) {
    return {{"$ref", components_prefix + schema}};
}

constexpr const char *examples_prefix = "#/components/examples/", *headers_prefix = "#/components/headers/";

/// Events are text; `schema` describes the data of each event.
json schema_of_body(const std::string& media_type, const std::string& schema) {
    if (media_type == "text/event-stream") return {{"type", "string"}, {"contentSchema", reference(schema)}};
    return schema.empty() ? json::object() : reference(schema);
}

json content(const std::string& media_type, const std::string& schema, const std::string& example) {
    json body = {{"schema", schema_of_body(media_type, schema)}};
    if (!example.empty()) body["examples"][example] = {{"$ref", examples_prefix + example}};
    return {{media_type, body}};
}

json error_reply(const std::string& description) {
    return {{"description", description}, {"content", content("application/problem+json", "Problem", "Problem")}};
}

/// The names between braces.
std::vector<std::string> path_names(const std::string& pattern) {
    std::vector<std::string> names;
    for (const std::string_view part : split(pattern, '/'))
        if (part.starts_with('{')) names.emplace_back(part.substr(1, part.size() - 2));
    return names;
}

/// What a {name} of a path is, and an example.
std::pair<std::string, std::string> described_path_value(const std::string& name) {
    if (name == "id") return {"id of a report", "01a2b3c4-0000-7000-8000-000000000001"};
    if (name == "sha256")
        return {"SHA-256 of its bytes, in lower-case hex digits",
                "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"};
    return {"its name", "main"};
}

json parameters_of(const Route& route) {
    json parameters = json::array();
    for (const std::string& name : path_names(route.pattern))
        parameters.push_back({{"name", name},
                              {"in", "path"},
                              {"description", described_path_value(name).first},
                              {"required", true},
                              {"schema", {{"type", "string"}}},
                              {"example", described_path_value(name).second}});
    const json fields = schema_of(route.query);
    const json required = fields.value("required", json::array());
    for (const Param& param : route.query) {
        json schema = fields["properties"][param.name];
        if (std::ranges::find(route.repeatable, param.name) != route.repeatable.end()) {
            schema.erase("default");
            schema = {{"type", "array"}, {"items", schema}};
        }
        parameters.push_back({{"name", param.name},
                              {"in", "query"},
                              {"description", param.summary},
                              {"required", std::ranges::find(required, json(param.name)) != required.end()},
                              {"schema", schema}});
    }
    for (const HeaderField& header : route.headers)
        parameters.push_back({{"name", header.name},
                              {"in", "header"},
                              {"description", header.summary},
                              {"schema", {{"type", "string"}}}});
    return parameters;
}

/// Whether Accept can rule out its answers.
bool answers_something(const Route& route) {
    return std::ranges::any_of(route.replies,
                               [](const Reply& reply) { return reply.status < 300 && !reply.media_type.empty(); });
}

json request_body(const Route& route) {
    json types = json::object();
    if (!route.body_schema.empty()) types = content("application/json", route.body_schema, route.body_schema);
    for (const std::string& type : route.body_types) types[type] = {{"schema", json::object()}};
    return {{"required", true}, {"content", types}};
}

/// The name of an example of its body; "" for none.
std::string example_of(const Reply& reply) {
    return reply.example.empty() && reply.media_type.ends_with("json") ? reply.schema : reply.example;
}

json response_of(const Reply& reply) {
    json response = {{"description", reply.description}};
    if (!reply.media_type.empty()) response["content"] = content(reply.media_type, reply.schema, example_of(reply));
    for (const std::string& header : reply.headers) response["headers"][header] = {{"$ref", headers_prefix + header}};
    return response;
}

json operation_of(const Route& route) {
    json operation = {{"operationId", route.id},
                      {"summary", route.summary},
                      {"description", route.description.empty() ? route.summary + "." : route.description},
                      {"tags", {route.tag}},
                      {"responses", json::object()}};
    if (json parameters = parameters_of(route); !parameters.empty()) operation["parameters"] = parameters;
    json& responses = operation["responses"];
    for (const Reply& reply : route.replies) responses[std::to_string(reply.status)] = response_of(reply);
    if (!route.query.empty())
        responses["400"] =
            error_reply(route.wrong_query_status == 400 ? "The query is wrong" : "The query cannot be read");
    if (!route.body_schema.empty() || !route.body_types.empty()) {
        operation["requestBody"] = request_body(route);
        if (!route.body_schema.empty()) responses["400"] = error_reply("The body is not JSON");
        responses["413"] = error_reply("The body is too long");
        responses["415"] = error_reply("The type of the body is not accepted, or it is compressed");
        responses["415"]["headers"]["Accept"] = {{"$ref", headers_prefix + std::string("Accept")}};
    }
    if (answers_something(route)) responses["406"] = error_reply("Accept allows none of the types that there are");
    if (const Scope scope = route.needed_scope(); scope != Scope::none) {
        responses["401"] = error_reply("The service asks for a token");
        responses["403"] = error_reply(
            fmt::format("The token has not the scope {}, or the guard refuses the request", scope_text(scope)));
    }
    responses["default"] = error_reply("An error");
    return operation;
}

/// Otherwise a reference to an unknown component would go unnoticed until a client is generated from the document.
class Checked {
  public:
    Checked(std::map<std::string, json> schemas, std::map<std::string, json> examples)
        : m_schemas(std::move(schemas)), m_examples(std::move(examples)) {}

    void require(const Route& route) const {
        require(route, "schema", m_schemas, route.body_schema);
        require(route, "example", m_examples, route.body_schema);
        for (const Reply& reply : route.replies) {
            if (reply.media_type.ends_with("json") && reply.schema.empty())
                throw std::logic_error(fmt::format("{} answers JSON without a schema", route.id));
            require(route, "schema", m_schemas, reply.schema);
            require(route, "example", m_examples, example_of(reply));
            for (const std::string& header : reply.headers) require(route, "header", described_headers(), header);
        }
    }

    json components() const {
        json headers = json::object(), examples = json::object();
        for (const auto& [name, description] : described_headers())
            headers[name] = {{"description", description}, {"schema", {{"type", "string"}}}};
        for (const auto& [name, value] : m_examples) examples[name] = {{"value", value}};
        const json token = {
            {"type", "http"}, {"scheme", "bearer"}, {"description", "What `sheer token create` printed"}};
        return {{"schemas", m_schemas},
                {"headers", headers},
                {"examples", examples},
                {"securitySchemes", {{"token", token}}}};
    }

  private:
    template <typename Value>
    static void require(const Route& route, const char* kind, const std::map<std::string, Value>& known,
                        const std::string& name) {
        if (!name.empty() && !known.contains(name))
            throw std::logic_error(fmt::format("{} names an unknown {}: {}", route.id, kind, name));
    }

    std::map<std::string, json> m_schemas, m_examples;
};

}  // namespace

json openapi_document(const std::vector<Route>& routes, const std::vector<Tag>& tags, const std::string& path_prefix) {
    const Checked checked(component_schemas(), openapi_examples());
    json paths = json::object();
    for (const Route& route : routes) {
        if (route.id.empty()) continue;
        checked.require(route);
        std::string method = route.method;
        std::ranges::transform(method, method.begin(), [](unsigned char c) { return std::tolower(c); });
        paths[route.pattern][method] = operation_of(route);
    }
    json groups = json::array();
    for (const Tag& tag : tags) groups.push_back({{"name", tag.name}, {"description", tag.description}});
    return {{"openapi", "3.1.0"},
            {"info",
             {{"title", "Sheer"},
              {"version", version},
              {"summary", "Compares transparency methods"},
              {"description", "Post a spec, wait for its report, and read a verdict with reasons."},
              {"contact", {{"name", "Whoever runs this service"}}},
              {"license", {{"name", "Apache License 2.0"}, {"identifier", "Apache-2.0"}}}}},
            {"servers",
             {{{"url", path_prefix.empty() ? "/" : path_prefix}, {"description", "The service that answers this"}}}},
            // A service without tokens asks for none.
            {"security", json::array({json::object(), json{{"token", json::array()}}})},
            {"tags", groups},
            {"paths", paths},
            {"components", checked.components()}};
}

}  // namespace sheer::http
