#include "server/jobs/facets.h"

#include <algorithm>

namespace sheer {

using nlohmann::json;

namespace {

/// The value at `pointer`, or null.
json at(const json& document, const char* pointer) {
    return document.value(json::json_pointer(pointer), json());
}

std::string text_at(const json& document, const char* pointer) {
    const json value = at(document, pointer);
    return value.is_string() ? value.get<std::string>() : std::string();
}

}  // namespace

Facets facets_of(const json& spec) {
    if (!spec.is_object()) return {};
    Facets facets{.title = text_at(spec, "/title"), .scene = text_at(spec, "/scene/type")};
    for (const json& method : at(spec, "/methods")) {
        std::string id = method.is_string() ? method.get<std::string>() : text_at(method, "/id");
        if (std::ranges::find(facets.methods, id) == facets.methods.end()) facets.methods.push_back(std::move(id));
    }
    const json tags = at(spec, "/tags");
    for (const auto& [name, value] : tags.items())
        if (tags.is_object() && value.is_string()) facets.tags[name] = value;
    return facets;
}

std::vector<std::string> wanted_devices(const json& spec) {
    const std::string one = spec.is_object() ? text_at(spec, "/device") : std::string();
    return one.empty() ? listed_devices(spec) : std::vector<std::string>{one};
}

std::vector<std::string> listed_devices(const json& spec) {
    std::vector<std::string> labels;
    if (!spec.is_object()) return labels;
    const json list = at(spec, "/device");
    for (const json& label : list)
        if (list.is_array() && label.is_string()) labels.push_back(label.get<std::string>());
    return labels;
}

std::string renderer_of(const json& report) {
    return report.is_object() ? text_at(report, "/device/renderer") : std::string();
}

json preview_of(const json& report) {
    for (const char* pointer : {"/runs/0/reference/images/color", "/runs/0/results/0/images/color"}) {
        const json image = at(report, pointer);
        if (image.is_object() && image.contains("url")) return image;
    }
    return nullptr;
}

}  // namespace sheer
