#include "renderer/spec/swept_schema.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "renderer/methods/shared/method.h"
#include "renderer/scene/scene_info.h"
#include "renderer/spec/spec_fields.h"

namespace sheer {

using nlohmann::json;

namespace {

constexpr const char* any_index = "(?:0|[1-9][0-9]*)";

/// The allowed values by patterns of JSON pointers. Fields of different scenes may have the same pointer.
class SweptFields {
  public:
    SweptFields() {
        for (const Param& param : spec_fields())
            if (param.name == "image") add(param.fields, "/image");
        for (const SceneInfo& scene : all_scenes()) {
            add(scene.all_parameters(), "/scene");
            add(scene.look_parameters(), fmt::format("/methods/{}", any_index));
        }
        for (const MethodInfo& method : all_methods()) add(method.parameters, fmt::format("/methods/{}", any_index));
    }

    /// The joined patterns of all fields that allow the same values, and the schema of these values.
    std::map<std::string, json> by_pattern() const {
        std::map<std::string, std::vector<std::string>> alike;
        for (const auto& [pointer, schemas] : m_schemas)
            alike[schemas.size() == 1 ? schemas[0].dump() : json{{"anyOf", schemas}}.dump()].push_back(pointer);
        std::map<std::string, json> joined;
        for (const auto& [schema, pointers] : alike)
            joined[fmt::format("^(?:{})$", fmt::join(pointers, "|"))] = json::parse(schema);
        return joined;
    }

  private:
    void add(const std::vector<Param>& params, const std::string& pointer) {
        const json schemas = schema_of(params)["properties"];
        for (const Param& param : params) add(param, schemas[param.name], fmt::format("{}/{}", pointer, param.name));
    }

    void add(const Param& param, json schema, const std::string& pointer) {
        // Otherwise fields that differ only in these would not be joined.
        for (const char* remark : {"description", "default"}) schema.erase(remark);
        // Objects are described by their fields only: few sweeps set a whole object, and the schema would double in
        // size.
        if (param.kind == Param::Kind::object || param.kind == Param::Kind::list) {
            json whole = {{"type", schema["type"]}};
            if (param.kind == Param::Kind::list) whole["items"] = json::object();
            add_schema(pointer, whole);
        } else {
            add_schema(pointer, schema);
        }
        const std::string element = fmt::format("{}/{}", pointer, any_index);
        if (param.kind == Param::Kind::numbers) add_schema(element, schema["items"]);
        if (param.kind == Param::Kind::asset && param.max_length > 0) add_schema(element, schema["anyOf"][0]);
        if (param.kind == Param::Kind::list) {
            add_schema(element, {{"type", "object"}});
            add(param.fields, element);
        } else {
            add(param.fields, pointer);
        }
    }

    void add_schema(const std::string& pointer, const json& schema) {
        std::vector<json>& known = m_schemas[pointer];
        if (std::ranges::find(known, schema) == known.end()) known.push_back(schema);
    }

    std::map<std::string, std::vector<json>> m_schemas;
};

}  // namespace

json swept_point_schema() {
    json schema = {{"type", "object"}, {"additionalProperties", false}, {"patternProperties", json::object()}};
    for (const auto& [pattern, value] : SweptFields().by_pattern()) schema["patternProperties"][pattern] = value;
    return schema;
}

json swept_axis_schema() {
    json values = {{"type", "object"},
                   {"additionalProperties", false},
                   {"properties",
                    {{"pointer", {{"type", "string"}, {"pattern", "^/(?:scene|image|methods)/"}}},
                     {"values", {{"type", "array"}, {"minItems", 1}, {"items", json::object()}}}}},
                   {"required", {"pointer", "values"}}};
    for (const auto& [pattern, value] : SweptFields().by_pattern())
        values["allOf"].push_back(
            {{"if", {{"type", "object"}, {"properties", {{"pointer", {{"type", "string"}, {"pattern", pattern}}}}}}},
             {"then", {{"type", "object"}, {"properties", {{"values", {{"type", "array"}, {"items", value}}}}}}}});
    json point = swept_point_schema();
    point["minProperties"] = 1;
    const json points = {{"type", "object"},
                         {"additionalProperties", false},
                         {"properties", {{"points", {{"type", "array"}, {"minItems", 1}, {"items", point}}}}},
                         {"required", {"points"}}};
    return {{"oneOf", {values, points}}};
}

}  // namespace sheer
