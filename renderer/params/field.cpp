#include "renderer/params/field.h"

#include <cmath>
#include <stdexcept>

namespace sheer {

using nlohmann::json;

namespace {

Field field_of(const Param& param) {
    Field field{.name = param.name,
                .kind = param.kind,
                .summary = param.summary,
                .unit = param.unit,
                .default_value = default_of(param),
                .required = !may_be_absent(param),
                .suggestion = {param.suggestion},
                .exclusive = param.exclusive,
                .whole = param.whole,
                .optional = param.optional,
                .step = param.step > 1 ? param.step : 0,
                .parts = param.parts,
                .choices = param.choices,
                .asset_type = param.asset_type,
                .min_length = param.min_length,
                .max_length = param.max_length,
                .fields = fields_of(param.fields)};
    if (std::isfinite(param.min)) field.min.value = bound_of(param, param.min);
    if (std::isfinite(param.max)) field.max.value = bound_of(param, param.max);
    return field;
}

/// The schema of a value of a field of this kind.
json value_of_kind(Param::Kind kind) {
    switch (kind) {
        case Param::Kind::number:
            return {{"type", "number"}};
        case Param::Kind::integer:
            return {{"type", "integer"}};
        case Param::Kind::boolean:
            return {{"type", "boolean"}};
        case Param::Kind::choice:
        case Param::Kind::text:
            return {{"type", "string"}};
        case Param::Kind::numbers:
            return {{"type", "array"}, {"items", {{"type", "number"}}}};
        case Param::Kind::object:
            return {{"type", "object"}};
        case Param::Kind::list:
            return {{"type", "array"}, {"items", {{"type", "object"}}}};
        case Param::Kind::asset:
            return {{"type", {"string", "array"}}, {"items", {{"type", "string"}}}};
        case Param::Kind::any:
            return json::object();
    }
    throw std::logic_error("a field has an unknown kind");
}

/// The default of an optional object is null; that of any other object is an object.
json default_of_objects() {
    const json an_object = {{"enum", {word_of(Param::Kind::object)}}}, is_optional = {{"const", true}};
    const auto so = [](const char* type) {
        return json{{"type", "object"}, {"properties", {{"default", {{"type", type}}}}}};
    };
    return {{"if", {{"type", "object"}, {"properties", {{"kind", an_object}}}}},
            {"then",
             {{"if", {{"type", "object"}, {"properties", {{"optional", is_optional}}}, {"required", {"optional"}}}},
              {"then", so("null")},
              {"else", so("object")}}}};
}

json of_kind(Param::Kind kind, const char* word) {
    const json value = value_of_kind(kind);
    json value_or_null = value;
    if (value.contains("type")) {
        json types = value["type"].is_array() ? value["type"] : json::array({value["type"]});
        types.push_back("null");
        value_or_null["type"] = types;
    }
    return {{"if", {{"type", "object"}, {"properties", {{"kind", {{"enum", {word}}}}}}}},
            {"then", {{"type", "object"}, {"properties", {{"default", value_or_null}, {"suggestion", value}}}}}};
}

}  // namespace

std::vector<Field> fields_of(const std::vector<Param>& params) {
    std::vector<Field> fields;
    for (const Param& param : params) fields.push_back(field_of(param));
    return fields;
}

template <>
const Description<Field>& description_of() {
    const auto any = [](SchemaBook&) { return json::object(); };
    static const auto description =
        Description<Field>("Field", "a field of a spec, a parameter of a scene or a method, or a parameter of a query")
            .member(&Field::name, "name", "its key in the JSON object")
            .member(&Field::kind, "kind", "the kind of value; any: described elsewhere")
            .member(&Field::summary, "summary", "what it means")
            .member(&Field::unit, "unit", "\"\" if it has none")
            .json(&Field::default_value, "default", "the value if it is not given; null for none", any)
            .member(&Field::required, "required", "whether it must be given")
            .maybe(&Field::suggestion, "suggestion", "a form's initial value if the field must be given")
            .maybe(&Field::min, "min", "least value; of several numbers, for each of them")
            .maybe(&Field::max, "max", "greatest value; of several numbers, for each of them")
            .maybe(&Field::exclusive, "exclusive", "true if min and max themselves are not allowed")
            .maybe(&Field::whole, "whole", "true if each of several numbers must be whole")
            .maybe(&Field::optional, "optional", "true if it may be null")
            .maybe(&Field::step, "step", "only min and every step-th number from there are allowed")
            .maybe(&Field::parts, "parts", "the names of several numbers")
            .maybe(&Field::choices, "choices", "the allowed texts; of an asset: the built-in names")
            .maybe(&Field::asset_type, "asset_type", "texture, model or volume")
            .maybe(&Field::min_length, "min_length", "of a text, in bytes; of an array, in elements")
            .maybe(&Field::max_length, "max_length",
                   "of a text, in bytes; of an array, in elements; of an asset: the length of an array of assets in "
                   "its place")
            .maybe(&Field::fields, "fields",
                   "of an object, of the objects in a list, or of the object that may replace a choice");
    return description;
}

namespace detail {

json Codec<Field>::schema(SchemaBook& book) {
    return book.reference("Field", [](SchemaBook& to) {
        json schema = description_of<Field>().schema(to);
        for (const char* bound : {"min", "max"}) schema["properties"][bound]["type"] = "number";
        for (const auto& [kind, word] : Words<Param::Kind>::all) schema["allOf"].push_back(of_kind(kind, word));
        schema["allOf"].push_back(default_of_objects());
        return schema;
    });
}

}  // namespace detail

json to_json(const std::vector<Param>& fields) {
    return to_document(fields_of(fields));
}

}  // namespace sheer
