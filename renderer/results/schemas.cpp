#include "renderer/results/schemas.h"

#include <algorithm>

#include "renderer/methods/shared/method.h"
#include "renderer/params/param.h"

namespace sheer {

using nlohmann::json;

json parameters_schema(SchemaBook& book) {
    return book.reference("MethodParameters", [](SchemaBook&) {
        json properties = json::object();
        for (const MethodInfo& method : all_methods()) {
            const json own = schema_of(method.parameters);
            for (const auto& [name, schema] : own["properties"].items()) {
                json& meanings = properties[name]["anyOf"];
                if (std::ranges::find(meanings, schema) == meanings.end()) meanings.push_back(schema);
            }
        }
        return json{{"type", "object"},
                    {"description", "the parameters of a method by their names: docs/methods.md"},
                    {"properties", properties},
                    {"additionalProperties", false}};
    });
}

json findings_schema(SchemaBook&) {
    return {{"type", "object"}};
}

json point_schema(SchemaBook&) {
    return {{"type", "object"},
            {"propertyNames", {{"pattern", "^/"}}},
            {"additionalProperties",
             {{"type", {"number", "boolean", "string", "array", "object"}}, {"items", json::object()}}}};
}

json spec_reference(SchemaBook& book) {
    return book.reference(normalised_spec_name);
}

}  // namespace sheer
