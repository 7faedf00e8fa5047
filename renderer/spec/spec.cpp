#include "renderer/spec/spec.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "renderer/core/names.h"
#include "renderer/glsl/own_shading.h"
#include "renderer/methods/shared/method.h"
#include "renderer/metrics/shared/metric.h"
#include "renderer/params/json_text.h"
#include "renderer/params/param.h"
#include "renderer/results/quantity.h"
#include "renderer/scene/scene_info.h"
#include "renderer/spec/against_name.h"
#include "renderer/spec/spec_fields.h"
#include "renderer/spec/suites.h"

namespace sheer {

using nlohmann::json;

namespace {

constexpr std::size_t max_point_bytes = 500;  // of a point shown in an error

Param optional_number(std::string name, std::string summary) {
    Param param{.name = std::move(name), .summary = std::move(summary)};
    param.optional = true;
    return param;
}

/// A field that has its own reader; `max_length` if it is a list or an object.
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

std::vector<Param> check_fields() {
    Param metric = Param::choice("metric", "the number of the report that is checked", "flip.mean", checkable_names());
    Param method = Param::text("method", "label or id of a method", "", max_text_bytes);
    return {metric.required(), method.required(), optional_number("min", "least value that passes"),
            optional_number("max", "greatest value that passes"),
            any("at", "values by JSON pointer: the check applies only to points of the sweep that have them",
                json::object())};
}

std::vector<std::string> format_names() {
    std::vector<std::string> names;
    for (const PixelFormat format : pixel_formats) names.push_back(to_string(format));
    return names;
}

}  // namespace

std::vector<Param> spec_fields() {
    return {
        Param::text("title", "shown with the report", "", max_text_bytes),
        any("tags", fmt::format("an object of at most {} names and texts, by which the report can be found", max_tags),
            json::object(), max_tags),
        Param::object("image", "the picture that is rendered",
                      {Param::integer("width", "columns", "px", 512, 1, 4096),
                       Param::integer("height", "rows", "px", 512, 1, 4096),
                       Param::color("background", "color behind everything", {0, 0, 0}),
                       Param::choice("format", "format of the image into which the methods blend",
                                     to_string(ImageSpec().format), format_names())}),
        any("scene", "an object with the type of the scene and its parameters", nullptr),
        any("methods",
            fmt::format("an array of 1 to {} method ids, or objects with id, label and parameters", max_methods),
            nullptr, max_methods),
        any("reference", "the method with whose picture the others are compared", "exact"),
        optional_text("baseline",
                      "label or id of the method with which times are compared; by default b2f, or the first method if "
                      "there is no b2f"),
        Param::object(
            "timing", "how long each method is timed",
            {Param::integer("warmup", "frames before timing", "frames", 1, 1, 100),
             Param::integer("rounds", "timed frames of each method; doubled while checks on times are undecided",
                            "frames", 10, 1, 1000),
             Param::number("max_seconds", "no round begins after this", "s", 60, 0.001, 3600)}),
        optional_text("suite", "id of the published measurement that this one repeats, see GET /suites"),
        any("sweep",
            "an array of axes, each {pointer, values} or {points}; the comparison is made at every point of their "
            "Cartesian product",
            json::array(), max_sweeps),
        Param::list("checks", "conditions for the report to pass", check_fields(), 0, 256),
        Param::choice(
            "on_undecided",
            "what a check counts as that is undecided when the time is over: neutral is told and fails nothing",
            "neutral", {"pass", "fail", "neutral"}),
        any("device",
            fmt::format(
                "label of the workers that may render it, see GET /workers, or an array of 2 to {} labels: each "
                "of these devices renders every point, and the report compares them; by default any worker, "
                "and not there if it is not given",
                max_devices),
            nullptr, max_devices),
        Param::boolean("reuse",
                       "the service answers with a done report of the same spec, program and device if it has one; not "
                       "a part of what is compared",
                       false),
        optional_text("against",
                      "baseline:NAME or the id of a report: the service compares pictures and times with that report"),
        any("under_test", "JSON pointers into the spec of what may differ from the report of `against`", json::array(),
            max_under_test),
        Param::object("tolerance", "by how much the report may be worse than that of `against`",
                      {Param::number("max_flip", "mean FLIP error of a picture that changed", "", 0, 0, 1),
                       Param::number("max_slowdown", "a method's time, over its time before", "", 1.1, 1, 1000)}),
    };
}

namespace {

class SpecReader {
  public:
    /// `known_scene`: a spec with the same scene, which has already been read; null for none.
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
        // A wish of the sender, not a part of what is compared.
        normalised.erase("reuse");
        read_device(spec);
        read_against(spec);
        if (m_errors.empty()) {
            read_points(spec);
            repeat_points(spec);
            read_checks(spec);
        }
        if (!m_errors.empty()) throw SpecError(std::move(m_errors));
        return spec;
    }

  private:
    void error(const std::string& pointer, const std::string& detail) {
        add_error(m_errors, pointer, [&] { return detail; });
    }

    void read_device(Spec& spec) {
        json& device = spec.normalised["device"];
        if (device.is_array()) return read_devices(device, spec);
        // Specs without it keep the hash that they had before there were labels.
        if (device.is_null() || device == "")
            spec.normalised.erase("device");
        else if (!is_label(device))
            error("/device",
                  fmt::format("must be a text of at most {} bytes, or an array of such texts", max_text_bytes));
    }

    void read_devices(json& device, Spec& spec) {
        if (device.empty() || device.size() > max_devices)
            return error("/device", fmt::format("must be a label or an array of 1 to {} labels", max_devices));
        for (std::size_t i = 0; i < device.size(); ++i) {
            const std::string pointer = fmt::format("/device/{}", i);
            const auto before = device.begin() + static_cast<std::ptrdiff_t>(i);
            if (!is_label(device[i]))
                error(pointer, fmt::format("must be a text of 1 to {} bytes", max_text_bytes));
            else if (std::find(device.begin(), before, device[i]) != before)
                error(pointer, fmt::format("{} is listed twice", device[i].dump()));
            else
                spec.devices.push_back(device[i]);
        }
        for (const char* other : {"against", "suite"})
            if (!spec.normalised[other].is_null())
                error("/device", fmt::format("must be one label in a spec with `{}`", other));
        if (device.size() > 1) return;
        spec.devices.clear();
        device = json(device[0]);
    }

    static bool is_label(const json& label) {
        return label.is_string() && !label.get_ref<const std::string&>().empty() &&
               label.get_ref<const std::string&>().size() <= max_text_bytes;
    }

    void check_tags(const json& tags) {
        if (!tags.is_object() || tags.size() > max_tags) {
            error("/tags", fmt::format("must be an object of at most {} texts", max_tags));
            return;
        }
        for (const auto& [name, value] : tags.items()) {
            if (!value.is_string() || value.get_ref<const std::string&>().size() > max_text_bytes)
                error((json::json_pointer("/tags") / name).to_string(),
                      fmt::format("must be a text of at most {} bytes", max_text_bytes));
        }
    }

    static void read_image(const json& image, ImageSpec& out) {
        out.width_px = image["width"];
        out.height_px = image["height"];
        out.background = image["background"].get<std::array<float, 3>>();
        out.format = pixel_format_named(image["format"]);
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
        check_assets(scene_assets(spec.scene));
    }

    void check_assets(const std::vector<AssetReference>& references) {
        if (!m_rule) return;
        for (const AssetReference& reference : references)
            if (const std::string wrong = m_rule(reference); !wrong.empty()) error(reference.pointer, wrong);
    }

    /// `value` is an id, or an object with id, label and parameters, and with a look if there is a `scene`.
    MethodSpec read_method(const json& value, const std::string& pointer, const json* scene = nullptr) {
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
        MethodSpec method{info->id, read_label(parameters, pointer), {}, json::object(), pointer};
        parameters.erase("id");
        parameters.erase("label");
        if (scene != nullptr) method.look = read_look(parameters, *scene, pointer);
        method.parameters = read_fields(parameters, pointer, info->parameters, m_errors);
        return method;
    }

    /// Takes the look out of `method`. A texture that says only its picture or its size has the other from the scene.
    json read_look(json& method, const json& scene, const std::string& pointer) {
        const SceneInfo* info = scene.is_object() ? find_scene(scene.value("type", "")) : nullptr;
        json given = json::object();
        std::vector<Param> fields = info ? info->look_parameters() : std::vector<Param>();
        for (const char* name : {"shading", "texture"}) {
            if (!method.contains(name)) std::erase_if(fields, [&](const Param& field) { return field.name == name; });
            if (method.contains(name)) given[name] = method[name];
            method.erase(name);
        }
        if (!info || given.empty()) return json::object();
        if (given.contains("texture") && given["texture"].is_object()) {
            json texture = scene["texture"];
            texture.update(given["texture"]);
            given["texture"] = texture;
        }
        json look = read_fields(given, pointer, fields, m_errors);
        if (look.contains("shading")) check_glsl_shading(look, pointer, m_errors);
        check_assets(look_assets(*info, look, pointer));
        return look;
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
        object.update(method.look);
        return object;
    }

    void read_methods(const json& document, Spec& spec) {
        if (!document.contains("methods")) return error("/methods", "is missing: an array of methods");
        const json& methods = document["methods"];
        if (!methods.is_array() || methods.empty() || methods.size() > max_methods)
            return error("/methods", fmt::format("must be an array of 1 to {} methods", max_methods));
        for (std::size_t i = 0; i < methods.size(); ++i)
            spec.methods.push_back(read_method(methods[i], fmt::format("/methods/{}", i),
                                               m_known_scene ? &m_known_scene->scene : &spec.scene));
        set_labels(spec.methods);
        check_looks(spec.methods);
        spec.normalised["methods"] = json::array();
        for (const MethodSpec& method : spec.methods) spec.normalised["methods"].push_back(method_json(method));
    }

    /// Each look has textures and a reference of its own.
    void check_looks(const std::vector<MethodSpec>& methods) {
        std::vector<json> looks;
        for (const MethodSpec& method : methods)
            if (!method.look.empty() && std::ranges::find(looks, method.look) == looks.end())
                looks.push_back(method.look);
        if (looks.size() > max_looks)
            error("/methods", fmt::format("must have at most {} different looks (shading and texture)", max_looks));
    }

    /// Given labels must be unique; the others are the id, numbered if it is taken.
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

    /// The label of the method whose label or id is `name`. "" after adding an error.
    std::string resolve_method(const Spec& spec, const std::string& name, const std::string& pointer) {
        for (const MethodSpec& method : spec.methods)
            if (method.label == name) return method.label;
        for (const MethodSpec& method : spec.methods)
            if (method.id == lower_case(name)) return method.label;
        error(pointer, fmt::format("\"{}\" is neither the label nor the id of one of the methods", name));
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

    void read_against(Spec& spec) {
        const json& against = spec.normalised["against"];
        constexpr std::string_view prefix = "baseline:";
        if (against.is_string()) {
            spec.against = against;
            if (spec.against.empty()) error("/against", "must be baseline:NAME or the id of a report");
            if (spec.against.starts_with(prefix))
                if (const std::string wrong = wrong_baseline_name(spec.against.substr(prefix.size())); !wrong.empty())
                    error("/against", "the name of the baseline " + wrong);
        }
        const json& under_test = spec.normalised["under_test"];
        if (!under_test.is_array() || under_test.size() > max_under_test)
            return error("/under_test", fmt::format("must be an array of at most {} JSON pointers", max_under_test));
        for (std::size_t i = 0; i < under_test.size(); ++i) {
            const bool is_pointer = under_test[i].is_string() && is_json_pointer(under_test[i]);
            if (!is_pointer)
                error(fmt::format("/under_test/{}", i), "must be a JSON pointer such as /scene/shading/glsl");
        }
        if (!under_test.empty() && spec.against.empty())
            error("/under_test", "needs `against`, which names the report that may differ there");
    }

    static bool is_json_pointer(const json& text) {
        try {
            return !json::json_pointer(text.get<std::string>()).empty();
        } catch (const json::exception&) {
            return false;
        }
    }

    /// Every point is read as a separate spec, so that the error for a wrong value points into the sweep. If the sweep
    /// does not change the scene, it is read only once.
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
            return error("/sweep", "must have fewer points, as the spec is so large");
        for (const SweepPoint& point : spec.points) {
            try {
                SpecReader(m_rule, scene_is_swept ? nullptr : &spec).read(at_point(document, point));
            } catch (const SpecError& wrong) {
                add_errors_at(point, wrong, sweep);
            }
            // Enough errors to be useful, and a limit to the work that one spec can cause.
            if (m_errors.size() >= max_told_errors) return;
        }
    }

    /// Every device renders every point.
    void repeat_points(Spec& spec) {
        if (spec.devices.empty()) return;
        if (spec.points.size() * spec.devices.size() > max_sweep_points)
            return error("/device", fmt::format("must give at most {} points in all", max_sweep_points));
        std::vector<SweepPoint> all;
        for (const std::string& device : spec.devices)
            for (SweepPoint point : spec.points) {
                point[device_pointer] = device;
                all.push_back(std::move(point));
            }
        spec.points = std::move(all);
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
                error(pointer + "/at", "must be an object of values by JSON pointer that a point of the sweep has");
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

json spec_of_device(json normalised, const std::string& device) {
    normalised["device"] = device;
    json checks = json::array();
    for (json& check : normalised["checks"]) {
        if (check["at"].value(device_pointer, device) != device) continue;
        check["at"].erase(device_pointer);
        checks.push_back(std::move(check));
    }
    normalised["checks"] = std::move(checks);
    return normalised;
}

Spec spec_at(const Spec& spec, const SweepPoint& point) {
    return parse_spec(at_point(spec.normalised, point));
}

}  // namespace sheer
