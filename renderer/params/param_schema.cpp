// The JSON schemas of fields: as they may be posted, and normalised.
#include <fmt/format.h>

#include <cmath>

#include "renderer/params/described.h"
#include "renderer/params/param.h"

namespace sheer {

using nlohmann::json;

namespace {

enum class Form { as_posted, normalised };

json object_schema(const std::vector<Param>& fields, Form form);

/// In a posted spec only a field with a type can be null: a choice is left out instead.
json nullable(json schema, Form form) {
    if (form == Form::as_posted && !schema.contains("type")) return schema;
    return schema.empty() ? schema : detail::or_null(std::move(schema));
}

json value_schema(const Param& param, Form form) {
    json schema = json::object();
    switch (param.kind) {
        case Param::Kind::number:
            schema["type"] = "number";
            break;
        case Param::Kind::integer:
            schema["type"] = "integer";
            if (param.step > 1) schema["enum"] = values_in_steps(param);
            break;
        case Param::Kind::boolean:
            schema["type"] = "boolean";
            break;
        case Param::Kind::choice:
            schema["enum"] = param.choices;
            if (!param.fields.empty()) schema = {{"anyOf", {schema, object_schema(param.fields, form)}}};
            break;
        case Param::Kind::text:
            schema = {{"type", "string"}, {"minLength", param.min_length}, {"maxLength", param.max_length}};
            break;
        case Param::Kind::numbers:
            schema = {{"type", "array"}, {"minItems", param.max_length}, {"maxItems", param.max_length}};
            break;
        case Param::Kind::object:
            schema = object_schema(param.fields, form);
            break;
        case Param::Kind::list:
            schema = {{"type", "array"},
                      {"minItems", param.min_length},
                      {"maxItems", param.max_length},
                      {"items", object_schema(param.fields, form)}};
            break;
        case Param::Kind::asset:
            schema = {{"type", "string"}, {"minLength", 1}, {"maxLength", max_asset_name_bytes}};
            if (param.max_length > 0)
                schema = {{"anyOf",
                           {schema,
                            {{"type", "array"},
                             {"minItems", param.max_length},
                             {"maxItems", param.max_length},
                             {"items", schema}}}}};
            break;
        case Param::Kind::any:
            break;
    }
    json range = json::object();
    if (std::isfinite(param.min)) range[param.exclusive ? "exclusiveMinimum" : "minimum"] = bound_of(param, param.min);
    if (std::isfinite(param.max)) range[param.exclusive ? "exclusiveMaximum" : "maximum"] = bound_of(param, param.max);
    if (param.kind == Param::Kind::numbers) {
        range["type"] = param.whole ? "integer" : "number";
        schema["items"] = range;
    } else {
        schema.update(range);
    }
    if (form == Form::as_posted && !param.default_value.is_null()) schema["default"] = param.default_value;
    if (param.optional) schema = nullable(std::move(schema), form);
    schema["description"] = param.unit.empty() ? param.summary : fmt::format("{} [{}]", param.summary, param.unit);
    return schema;
}

json object_schema(const std::vector<Param>& fields, Form form) {
    json schema = {{"type", "object"}, {"additionalProperties", false}, {"properties", json::object()}};
    for (const Param& param : fields) {
        schema["properties"][param.name] = value_schema(param, form);
        if (form == Form::normalised || !may_be_absent(param)) schema["required"].push_back(param.name);
    }
    return schema;
}

}  // namespace

json schema_of(const std::vector<Param>& fields) {
    return object_schema(fields, Form::as_posted);
}

json normalised_schema_of(const std::vector<Param>& fields) {
    return object_schema(fields, Form::normalised);
}

}  // namespace sheer
