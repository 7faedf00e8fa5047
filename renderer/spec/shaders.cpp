#include "renderer/spec/shaders.h"

#include <algorithm>

namespace sheer {

std::vector<SpecShader> shaders_of(const Spec& spec) {
    std::vector<SpecShader> all;
    const auto add = [&](const std::string& pointer, const nlohmann::json& glsl) {
        if (!glsl.is_string()) return;
        const auto text = glsl.get<std::string>();
        if (std::ranges::find(all, text, &SpecShader::glsl) == all.end()) all.push_back({pointer, text});
    };
    const auto add_of = [&](const std::string& pointer, const nlohmann::json& owner) {
        const auto shading = owner.find("shading");
        if (shading != owner.end() && shading->is_object()) add(pointer + "/shading/glsl", shading->value("glsl", ""));
    };
    add_of("/scene", spec.scene);
    for (const MethodSpec& method : spec.methods) add_of(method.pointer, method.look);
    for (const SweepPoint& point : spec.points)
        for (const auto& [field, value] : point.items()) {
            const std::string axis = sweep_pointer(spec.normalised.at("sweep"), field);
            if (field.ends_with("/shading/glsl")) add(axis, value);
            if (field.ends_with("/shading") && value.is_object()) add(axis, value.value("glsl", ""));
        }
    return all;
}

}  // namespace sheer
