#include "renderer/spec/spec.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "renderer/methods/method.h"
#include "renderer/metrics/metric.h"
#include "renderer/scene/glsl_shading.h"
#include "renderer/scene/scene_info.h"
#include "renderer/spec/json_text.h"
#include "renderer/spec/names.h"
#include "renderer/spec/param.h"
#include "renderer/spec/suites.h"

namespace sheer {

using nlohmann::json;

namespace {

constexpr std::size_t max_methods = 64, max_tags = 32, max_text_bytes = 200;
constexpr std::size_t max_point_bytes = 500;  // of a point in the text of an error

Param optional_number(std::string name, std::string summary) {
    Param param{.name = std::move(name), .summary = std::move(summary)};
    param.optional = true;
    return param;
}

/// A field that is read by a description of its own; `max_length` where it is a list or an object.
Param any(std::string name, std::string summary, json fallback, std::size_t max_length = 0) {
    Param param{.name = std::move(name), .kind = Param::Kind::any, .summary = std::move(summary)};
    param.optional = true;
    param.default_value = std::move(fallback);
    param.max_length = max_length;
    return param;
}

Param optional_text(std::string name, std::string summary) {
    Param param = Param::text(std::move(name), std::move(summary), "", max_text_bytes);
    param.default_value = nullptr;
    param.optional = true;
    return param;
}

std::vector<std::string> metric_names() {
    std::vector<std::string> names = {
        "speedup",           "speedup_with_sort", "timing.sort.median",   "timing.median",
        "timing.min",        "timing.p95",        "fragments.submitted",  "fragments.shaded",
        "fragments.visible", "fragments.needed",  "fragments.efficiency", "memory_bytes"};
    for (const MetricInfo& metric : all_metrics())
        for (const MetricField& field : metric.fields)
            if (field.is_number) names.push_back(field.name.empty() ? metric.id : metric.id + "." + field.name);
    return names;
}

std::vector<Param> check_fields() {
    Param metric = Param::choice("metric", "the number of the report that is held", "flip.mean", metric_names());
    Param method = Param::text("method", "label or id of a method", "", max_text_bytes);
    return {metric.required(), method.required(), optional_number("min", "least value that passes"),
            optional_number("max", "greatest value that passes"),
            any("at", "values by pointer: only the points of the sweep that have them", json::object())};
}

/// The fields of a spec; scene, methods and reference are read by their own descriptions.
std::vector<Param> spec_fields() {
    return {
        Param::text("title", "shown with the report", "", max_text_bytes),
        any("tags", fmt::format("an object of at most {} names and texts to find the report by", max_tags),
            json::object(), max_tags),
        Param::object(
            "image", "the picture that is rendered",
            {Param::integer("width", "columns", "px", 512, 1, 4096),
             Param::integer("height", "rows", "px", 512, 1, 4096),
             Param::numbers("background", "red, green, blue behind everything", "", {0, 0, 0}, 0, 1),
             Param::choice("format", "what the methods blend into", "rgba8", {"rgba8", "rgba16f", "rgba32f"})}),
        any("scene", "an object with the type of the scene and its parameters", nullptr),
        any("methods",
            fmt::format("an array of 1 to {} method ids, or objects with id, label and parameters", max_methods),
            nullptr, max_methods),
        any("reference", "the method that the others are held against for differences", "exact"),
        optional_text("baseline", "label or id of the method that speed is held against; b2f, else the first"),
        Param::object("timing", "how long each method is timed",
                      {Param::integer("warmup", "frames before timing", "frames", 1, 1, 100),
                       Param::integer("rounds", "timed frames of each method", "frames", 10, 1, 1000),
                       Param::number("max_seconds", "no round begins after this", "s", 60, 0.001, 3600)}),
        optional_text("suite", "id of the published measurement that this one repeats, see GET /suites"),
        any("sweep",
            "an array of axes, each {pointer, values} or {points}: the comparison is made at every point of their "
            "Cartesian product",
            json::array(), max_sweeps),
        Param::list("checks", "what must hold for the report to pass", check_fields(), 0, 256),
    };
}

PixelFormat pixel_format(const std::string& name) {
    if (name == "rgba8") return PixelFormat::rgba8;
    return name == "rgba16f" ? PixelFormat::rgba16f : PixelFormat::rgba32f;
}

class SpecReader {
  public:
    /// `known_scene`: a spec whose scene was read already and is the one of this document; null for none.
    explicit SpecReader(const AssetRule& rule, const Spec* known_scene = nullptr)
        : m_rule(rule), m_known_scene(known_scene) {}

    Spec read(const json& document) {
        if (!document.is_object()) throw SpecError(std::vector<FieldError>{{"", "a spec must be a JSON object"}});
        Spec spec;
        spec.normalised = read_fields(document, "", spec_fields(), m_errors);
        json& normalised = spec.normalised;
        spec.title = normalised["title"];
        check_tags(normalised["tags"]);
        read_image(normalised["image"], spec.image);
        read_scene(document, spec);
        read_methods(document, spec);
        spec.reference = read_method(normalised["reference"], "/reference");
        normalised["reference"] = method_json(spec.reference);
        normalised["reference"].erase("label");
        if (m_errors.empty() || !spec.methods.empty()) {
            read_baseline(spec);
        }
        const json& timing = normalised["timing"];
        spec.timing = {timing["warmup"], timing["rounds"], timing["max_seconds"]};
        read_suite(spec);
        if (m_errors.empty()) {
            read_points(spec);
            read_checks(spec);
        }
        if (!m_errors.empty()) throw SpecError(std::move(m_errors));
        return spec;
    }

  private:
    void error(const std::string& pointer, const std::string& detail) {
        add_error(m_errors, pointer, [&] { return detail; });
    }

    void check_tags(const json& tags) {
        if (!tags.is_object() || tags.size() > max_tags) {
            error("/tags", fmt::format("must be an object of at most {} texts", max_tags));
            return;
        }
        for (const auto& [name, value] : tags.items()) {
            if (!value.is_string() || value.get_ref<const std::string&>().size() > max_text_bytes)
                error("/tags/" + pointer_token(name),
                      fmt::format("must be a text of at most {} bytes", max_text_bytes));
        }
    }

    static void read_image(const json& image, ImageSpec& out) {
        out.width_px = image["width"];
        out.height_px = image["height"];
        out.background = image["background"].get<std::array<float, 3>>();
        out.format = pixel_format(image["format"]);
    }

    void read_scene(const json& document, Spec& spec) {
        if (m_known_scene != nullptr) {
            spec.scene_type = m_known_scene->scene_type;
            return;
        }
        if (!document.contains("scene")) return error("/scene", "is missing: an object with type and parameters");
        json scene = document["scene"];
        if (!scene.is_object()) return error("/scene", "must be an object with type and parameters");
        if (!scene.contains("type") || !scene["type"].is_string())
            return error("/scene/type", "must be one of " + joined_ids(all_scenes()));
        const SceneInfo* info = find_scene(scene["type"]);
        if (info == nullptr)
            return error("/scene/type", fmt::format("must be one of {}, not \"{}\"", joined_ids(all_scenes()),
                                                    scene["type"].get<std::string>()));
        scene.erase("type");
        spec.scene_type = info->id;
        spec.scene = read_fields(scene, "/scene", info->all_parameters(), m_errors);
        check_glsl_shading(spec.scene, "/scene", m_errors);
        if (info->check) info->check(spec.scene, "/scene", m_errors);
        spec.scene["type"] = info->id;
        spec.normalised["scene"] = spec.scene;
        check_assets(spec.scene);
    }

    void check_assets(const json& scene) {
        if (!m_rule) return;
        for (const AssetReference& reference : scene_assets(scene))
            if (const std::string wrong = m_rule(reference); !wrong.empty()) error(reference.pointer, wrong);
    }

    /// `value` is an id, or an object with id, label and parameters.
    MethodSpec read_method(const json& value, const std::string& pointer) {
        json parameters = value.is_object() ? value : json{{"id", value}};
        const bool has_id = parameters.contains("id") && parameters["id"].is_string();
        const std::string id_pointer = value.is_object() ? pointer + "/id" : pointer;
        if (!has_id) {
            error(id_pointer, "must be a method id or an object with one; known are " + joined_ids(all_methods()));
            return {};
        }
        const MethodInfo* info = find_method(parameters["id"]);
        if (info == nullptr) {
            error(id_pointer, fmt::format("there is no method \"{}\"; known are {}",
                                          parameters["id"].get<std::string>(), joined_ids(all_methods())));
            return {};
        }
        MethodSpec method{info->id, read_label(parameters, pointer), {}};
        parameters.erase("id");
        parameters.erase("label");
        method.parameters = read_fields(parameters, pointer, info->parameters, m_errors);
        return method;
    }

    std::string read_label(const json& parameters, const std::string& pointer) {
        if (!parameters.contains("label")) return "";
        const json& label = parameters["label"];
        if (label.is_string() && !label.get_ref<const std::string&>().empty() &&
            label.get_ref<const std::string&>().size() <= max_text_bytes)
            return label;
        error(pointer + "/label", fmt::format("must be a text of 1 to {} bytes", max_text_bytes));
        return "";
    }

    static json method_json(const MethodSpec& method) {
        json object = method.parameters.is_object() ? method.parameters : json::object();
        object["id"] = method.id;
        object["label"] = method.label;
        return object;
    }

    void read_methods(const json& document, Spec& spec) {
        if (!document.contains("methods")) return error("/methods", "is missing: an array of methods");
        const json& methods = document["methods"];
        if (!methods.is_array() || methods.empty() || methods.size() > max_methods)
            return error("/methods", fmt::format("must be an array of 1 to {} methods", max_methods));
        for (std::size_t i = 0; i < methods.size(); ++i)
            spec.methods.push_back(read_method(methods[i], fmt::format("/methods/{}", i)));
        set_labels(spec.methods);
        spec.normalised["methods"] = json::array();
        for (const MethodSpec& method : spec.methods) spec.normalised["methods"].push_back(method_json(method));
    }

    /// Labels that are given must be unique; the others are the id, numbered where that is taken.
    void set_labels(std::vector<MethodSpec>& methods) {
        std::vector<std::string> taken;
        const auto is_taken = [&](const std::string& label) { return std::ranges::find(taken, label) != taken.end(); };
        for (std::size_t i = 0; i < methods.size(); ++i) {
            if (methods[i].label.empty()) continue;
            if (is_taken(methods[i].label))
                error(fmt::format("/methods/{}/label", i),
                      fmt::format("\"{}\" is taken by another method", methods[i].label));
            taken.push_back(methods[i].label);
        }
        for (MethodSpec& method : methods) {
            if (!method.label.empty() || method.id.empty()) continue;
            method.label = method.id;
            for (int number = 2; is_taken(method.label); ++number)
                method.label = fmt::format("{} {}", method.id, number);
            taken.push_back(method.label);
        }
    }

    /// The label of the method that `name` means: a label, or the id of one. "" after adding an error.
    std::string resolve_method(const Spec& spec, const std::string& name, const std::string& pointer) {
        for (const MethodSpec& method : spec.methods)
            if (method.label == name) return method.label;
        for (const MethodSpec& method : spec.methods)
            if (method.id == lower_case(name)) return method.label;
        error(pointer, fmt::format("\"{}\" is neither label nor id of one of the methods", name));
        return "";
    }

    void read_baseline(Spec& spec) {
        json& baseline = spec.normalised["baseline"];
        if (!baseline.is_null()) {
            spec.baseline = resolve_method(spec, baseline, "/baseline");
        } else if (!spec.methods.empty()) {
            const auto b2f = std::ranges::find(spec.methods, "b2f", &MethodSpec::id);
            spec.baseline = (b2f != spec.methods.end() ? *b2f : spec.methods.front()).label;
        }
        baseline = spec.baseline;
    }

    void read_suite(Spec& spec) {
        const json& suite = spec.normalised["suite"];
        if (suite.is_null()) return;
        if (const Suite* found = find_suite(suite)) {
            spec.suite = found->id;
        } else {
            error("/suite", fmt::format("must be one of {}, not {}", joined_ids(all_suites()), suite.dump()));
        }
    }

    /// Every point is read as a spec of its own, so that a value is refused where it stands in the sweep. A scene in
    /// which nothing is swept is the same at all points and is not read again.
    void read_points(Spec& spec) {
        const json& sweep = spec.normalised["sweep"];
        spec.points = read_sweep(sweep, spec.normalised, m_errors);
        if (!m_errors.empty() || sweep.empty()) return;
        const bool scene_is_swept = std::ranges::any_of(spec.points, reaches_into_scene);
        json document = spec.normalised;
        document.erase("sweep");
        document.erase("checks");
        if (!scene_is_swept) document["scene"] = nullptr;
        if (json_weight(document) * spec.points.size() > max_sweep_weight)
            return error("/sweep", "must have fewer points for a spec that is so large");
        for (const SweepPoint& point : spec.points) {
            try {
                SpecReader(m_rule, scene_is_swept ? nullptr : &spec).read(at_point(document, point));
            } catch (const SpecError& wrong) {
                add_errors_at(point, wrong, sweep);
            }
            // Enough to go by, and a limit to the work that one spec can make.
            if (m_errors.size() >= max_told_errors) return;
        }
    }

    static bool reaches_into_scene(const SweepPoint& point) {
        for (const auto& [field, value] : point.items())
            if (field.starts_with("/scene/")) return true;
        return false;
    }

    void add_errors_at(const SweepPoint& point, const SpecError& wrong, const json& sweep) {
        for (const FieldError& field : wrong.errors()) {
            const std::string detail =
                fmt::format("at {}: {} {}", shortened_json(point, max_point_bytes), field.pointer, field.detail);
            if (std::ranges::none_of(m_errors, [&](const FieldError& known) { return known.detail == detail; }))
                error(sweep_pointer(sweep, field.pointer), detail);
        }
    }

    void read_checks(Spec& spec) {
        json& checks = spec.normalised["checks"];
        for (std::size_t i = 0; i < checks.size(); ++i) {
            const std::string pointer = fmt::format("/checks/{}", i);
            json& check = checks[i];
            if (!check["metric"].is_string() || !check["method"].is_string()) continue;
            if (check["min"].is_null() && check["max"].is_null()) error(pointer, "needs a min or a max");
            check["method"] = resolve_method(spec, check["method"], pointer + "/method");
            if (!matches_any(spec.points, check["at"]))
                error(pointer + "/at", "must be values by pointer that a point of the sweep has");
            spec.checks.push_back({check["metric"], check["method"], check["min"], check["max"], check["at"]});
        }
    }

    static bool matches_any(const std::vector<SweepPoint>& points, const json& at) {
        return at.is_object() &&
               std::ranges::any_of(points, [&](const SweepPoint& point) { return lies_at(point, at); });
    }

    const AssetRule& m_rule;
    const Spec* m_known_scene;
    std::vector<FieldError> m_errors;
};

}  // namespace

std::string to_string(PixelFormat format) {
    switch (format) {
        case PixelFormat::rgba8:
            return "rgba8";
        case PixelFormat::rgba16f:
            return "rgba16f";
        case PixelFormat::rgba32f:
            return "rgba32f";
    }
    throw std::logic_error("unknown pixel format");
}

Spec parse_spec(const json& document, const AssetRule& rule) {
    return SpecReader(rule).read(document);
}

Spec parse_spec_text(const std::string& text) {
    try {
        return parse_spec(read_json(text));
    } catch (const NotJson& error) {
        throw SpecError(std::vector<FieldError>{{"", std::string("is not JSON: ") + error.what()}});
    }
}

Spec spec_at(const Spec& spec, const SweepPoint& point) {
    return parse_spec(at_point(spec.normalised, point));
}

json spec_schema() {
    json schema = schema_of(spec_fields());
    schema["required"] = {"scene", "methods"};
    json scenes = json::array(), methods = json::array();
    for (const SceneInfo& scene : all_scenes()) {
        json one = schema_of(scene.all_parameters());
        one["title"] = scene.name;
        one["description"] = scene.summary;
        one["properties"]["type"] = {{"const", scene.id}};
        one["required"].push_back("type");
        scenes.push_back(one);
    }
    json ids = json::array();
    for (const MethodInfo& method : all_methods()) {
        ids.push_back(method.id);
        json one = schema_of(method.parameters);
        one["title"] = method.name;
        one["description"] = method.summary;
        one["properties"]["id"] = {{"const", method.id}};
        one["properties"]["label"] = {{"type", "string"}, {"minLength", 1}, {"maxLength", max_text_bytes}};
        one["required"].push_back("id");
        methods.push_back(one);
    }
    methods.push_back({{"enum", ids}});
    json& properties = schema["properties"];
    properties["tags"]["type"] = "object";
    properties["tags"]["maxProperties"] = max_tags;
    properties["sweep"].update({{"type", "array"}, {"maxItems", max_sweeps}});
    properties["tags"]["additionalProperties"] = {{"type", "string"}, {"maxLength", max_text_bytes}};
    properties["scene"]["oneOf"] = scenes;
    properties["reference"]["oneOf"] = methods;
    properties["methods"].update(
        {{"type", "array"}, {"minItems", 1}, {"maxItems", max_methods}, {"items", {{"oneOf", methods}}}});
    return schema;
}

json describe_spec_fields() {
    return to_json(spec_fields());
}

}  // namespace sheer
