// The JSON schemas of a spec: as it may be posted, and with its defaults filled in.
#include <algorithm>

#include "renderer/methods/shared/method.h"
#include "renderer/params/param.h"
#include "renderer/scene/scene_info.h"
#include "renderer/spec/spec.h"
#include "renderer/spec/spec_fields.h"
#include "renderer/spec/sweep.h"
#include "renderer/spec/swept_schema.h"

namespace sheer {

using nlohmann::json;

namespace {

using SchemaOf = json (*)(const std::vector<Param>&);

json label_schema() {
    return {{"type", "string"}, {"minLength", 1}, {"maxLength", max_text_bytes}};
}

/// A label, or a list of `least` or more.
json device_schema(std::size_t least) {
    return {{"oneOf",
             {{{"type", "string"}, {"maxLength", max_text_bytes}},
              {{"type", "array"},
               {"minItems", least},
               {"maxItems", max_devices},
               {"uniqueItems", true},
               {"items", label_schema()}}}}};
}

json scene_schemas(SchemaOf object) {
    json scenes = json::array();
    for (const SceneInfo& scene : all_scenes()) {
        json one = object(scene.all_parameters());
        one["title"] = scene.name;
        one["description"] = scene.summary;
        one["properties"]["type"] = {{"const", scene.id}};
        one["required"].push_back("type");
        scenes.push_back(one);
    }
    return scenes;
}

/// Objects by their id.
json method_schemas(SchemaOf object) {
    json methods = json::array();
    for (const MethodInfo& method : all_methods()) {
        json one = object(method.parameters);
        one["title"] = method.name;
        one["description"] = method.summary;
        one["properties"]["id"] = {{"const", method.id}};
        one["required"].push_back("id");
        methods.push_back(one);
    }
    return methods;
}

/// The looks that a method may have, in any scene: a method knows nothing of the scene's type.
json look_schemas(SchemaOf object) {
    std::vector<Param> fields = all_scenes().front().look_parameters();
    for (const SceneInfo& scene : all_scenes()) {
        if (scene.own_shading.empty()) continue;
        std::vector<std::string>& names = fields.front().choices;
        if (std::ranges::find(names, scene.own_shading) == names.end()) names.push_back(scene.own_shading);
    }
    json look = object(fields)["properties"];
    for (json& field : look) {
        field["description"] = "instead of the scene's own: docs/ci.md";
        field.erase("default");
    }
    for (json& part : look["texture"]["properties"]) part.erase("default");
    return look;
}

json with_label(json methods, SchemaOf object, bool is_required) {
    const json looks = look_schemas(object);
    for (json& method : methods) {
        method["properties"].update(looks);
        method["properties"]["label"] = label_schema();
        if (is_required) method["required"].push_back("label");
    }
    return methods;
}

json with_ids(json methods) {
    json ids = json::array();
    for (const MethodInfo& method : all_methods()) ids.push_back(method.id);
    methods.push_back({{"enum", ids}});
    return methods;
}

/// The fields that have their own readers, in either form.
void add_own_fields(json& schema, SchemaOf object, const json& methods) {
    json& properties = schema["properties"];
    properties["tags"].update({{"type", "object"},
                               {"maxProperties", max_tags},
                               {"additionalProperties", {{"type", "string"}, {"maxLength", max_text_bytes}}}});
    properties["sweep"].update({{"type", "array"}, {"maxItems", max_sweeps}, {"items", swept_axis_schema()}});
    properties["scene"]["oneOf"] = scene_schemas(object);
    properties["methods"].update(
        {{"type", "array"}, {"minItems", 1}, {"maxItems", max_methods}, {"items", {{"oneOf", methods}}}});
    properties["under_test"].update(
        {{"type", "array"}, {"maxItems", max_under_test}, {"items", {{"type", "string"}, {"pattern", "^/"}}}});
    json& at = properties["checks"]["items"]["properties"]["at"];
    at.update(swept_point_schema());
    at["patternProperties"]["^/device$"] = label_schema();
}

}  // namespace

json spec_schema() {
    json schema = schema_of(spec_fields());
    schema["required"] = {"scene", "methods"};
    schema["properties"]["device"].update(device_schema(1));
    schema["properties"]["device"]["oneOf"].push_back({{"type", "null"}});
    const json methods = with_ids(with_label(method_schemas(schema_of), schema_of, false));
    add_own_fields(schema, schema_of, methods);
    schema["properties"]["reference"]["oneOf"] = with_ids(method_schemas(schema_of));
    return schema;
}

json normalised_spec_schema() {
    json schema = normalised_schema_of(spec_fields());
    add_own_fields(schema, normalised_schema_of,
                   with_label(method_schemas(normalised_schema_of), normalised_schema_of, true));
    schema["properties"]["reference"]["oneOf"] = method_schemas(normalised_schema_of);
    schema["properties"].erase("reuse");
    schema["properties"]["device"].update(device_schema(2));
    for (const char* name : {"reuse", "device"}) std::erase(schema["required"].get_ref<json::array_t&>(), json(name));
    json baseline = label_schema();
    baseline["description"] = "label of the method with which times are compared";
    schema["properties"]["baseline"] = baseline;
    schema["description"] = "A spec with its defaults filled in: configs/README.md";
    return schema;
}

json describe_spec_fields() {
    return to_json(spec_fields());
}

}  // namespace sheer
