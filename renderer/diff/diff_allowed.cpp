#include <fmt/format.h>

#include <algorithm>

#include "renderer/diff/diff_parts.h"
#include "renderer/params/json_text.h"

namespace sheer {

using nlohmann::json;

namespace {

// If there are more fields than this, the parts of the spec that contain them are offered instead.
constexpr std::size_t max_fields_offered = 8;

const std::string in_spec = "/spec";

bool sweeps_methods(const report::Report& report) {
    return std::ranges::any_of(report.runs, [](const report::Run& run) {
        return std::ranges::any_of(run.point.items(),
                                   [](const auto& value) { return value.key().starts_with("/methods/"); });
    });
}

/// Whether the field determines how a picture of a method looks.
bool shapes_pictures(const std::string& pointer) {
    return pointer.starts_with("/spec/image/") || pointer.starts_with("/spec/scene") ||
           pointer.starts_with("/spec/methods/");
}

/// Pictures of different sizes cannot be compared pixel by pixel.
bool is_size(const std::string& pointer) {
    return pointer == "/spec/image/width" || pointer == "/spec/image/height";
}

void check_pointers(const std::vector<std::string>& allow) {
    std::vector<FieldError> errors;
    for (const std::string& pointer : allow) {
        try {
            static_cast<void>(json::json_pointer(pointer));
        } catch (const json::exception&) {
            errors.push_back(
                {"/allow", fmt::format("\"{}\" is not a JSON pointer such as /scene/shading/glsl", pointer)});
        }
    }
    if (!errors.empty()) throw SpecError(errors);
}

/// Whether the field at `pointer`, which begins with /spec, is one of `allow` or lies below one.
bool is_allowed(const std::string& pointer, const std::vector<std::string>& allow) {
    return std::ranges::any_of(allow, [&](const std::string& allowed) {
        const std::string place = in_spec + allowed;
        return pointer == place || pointer.starts_with(place + "/");
    });
}

/// "/scene" of "/scene/texture/size".
std::string part_of_spec(const std::string& pointer) {
    return pointer.substr(0, pointer.find('/', 1));
}

/// The pointers that allow all of these fields.
std::vector<std::string> offered(std::vector<std::string> fields) {
    if (fields.size() <= max_fields_offered) return fields;
    std::vector<std::string> parts;
    for (const std::string& field : fields)
        if (std::ranges::find(parts, part_of_spec(field)) == parts.end()) parts.push_back(part_of_spec(field));
    return parts;
}

}  // namespace

std::vector<std::string> method_labels(const report::Report& report) {
    std::vector<std::string> all;
    for (const json& method : report.spec.at("methods")) all.push_back(method.at("label"));
    return all;
}

void check_specs(const report::Report& a, const report::Report& b, const std::vector<std::string>& allow,
                 std::vector<FieldDifference>& differences) {
    check_pointers(allow);
    std::vector<FieldError> errors;
    std::vector<std::string> fields;
    bool can_be_allowed = true;
    for (FieldDifference& one : differences) {
        if (!one.is_in_both || !shapes_pictures(one.pointer)) continue;
        one.allowed = !is_size(one.pointer) && is_allowed(one.pointer, allow);
        if (one.allowed) continue;
        std::string detail = fmt::format("is {} in one report and {} in the other", json_line(one.a), json_line(one.b));
        if (is_size(one.pointer)) {
            can_be_allowed = false;
            detail += "; pictures of different sizes cannot be compared, even if that is allowed";
        }
        errors.push_back({one.pointer, detail});
        fields.push_back(one.pointer.substr(in_spec.size()));
    }
    // A sweep refers to methods by index, so its points would set parameters of different methods.
    if (method_labels(a) != method_labels(b) && (sweeps_methods(a) || sweeps_methods(b))) {
        can_be_allowed = false;
        errors.push_back({"/spec/methods", "must be the same in both reports, as the sweep sets their parameters"});
    }
    if (errors.empty()) return;
    if (!can_be_allowed) fields.clear();
    throw DiffConflict(std::move(errors), offered(std::move(fields)));
}

}  // namespace sheer
