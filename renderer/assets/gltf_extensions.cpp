#include "renderer/assets/gltf_extensions.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>

namespace sheer {

using nlohmann::json;

namespace {

constexpr std::array read_names = {"EXT_mesh_gpu_instancing",
                                   "EXT_meshopt_compression",
                                   "EXT_texture_webp",
                                   "KHR_draco_mesh_compression",
                                   "KHR_materials_emissive_strength",
                                   "KHR_materials_pbrSpecularGlossiness",
                                   "KHR_materials_transmission",
                                   "KHR_materials_unlit",
                                   "KHR_mesh_quantization",
                                   "KHR_node_visibility",
                                   "KHR_texture_transform"};

/// Prefixes of the names of extensions for lights, animation and behaviour, for reflections and other shading models,
/// for sound, physics and metadata, and for levels of detail and other variants of the same data.
constexpr std::array beside_beginnings = {"AGI_",
                                          "CESIUM_primitive_outline",
                                          "EXT_feature_metadata",
                                          "EXT_instance_features",
                                          "EXT_lights_",
                                          "EXT_mesh_features",
                                          "EXT_structural_metadata",
                                          "FB_geometry_metadata",
                                          "KHR_animation",
                                          "KHR_audio",
                                          "KHR_collision_shapes",
                                          "KHR_implicit_shapes",
                                          "KHR_interactivity",
                                          "KHR_lights_",
                                          "KHR_materials_",
                                          "KHR_node_",
                                          "KHR_physics_",
                                          "KHR_rigid_bodies",
                                          "KHR_techniques_webgl",
                                          "KHR_xmp",
                                          "MSFT_lod",
                                          "OMI_",
                                          "VRM"};

std::string below(const std::string& where, const std::string& name) {
    return where.empty() ? name : where + "." + name;
}

void find_uses(const json& value, const std::string& where, std::map<std::string, std::string>& uses) {
    if (value.is_array()) {
        for (std::size_t i = 0; i < value.size(); ++i) find_uses(value[i], where + "[" + std::to_string(i) + "]", uses);
    } else if (value.is_object()) {
        for (const auto& [name, inner] : value.items()) {
            if (name == "extensions" && inner.is_object())
                for (const auto& [extension, ignored] : inner.items())
                    uses.try_emplace(extension, below(where, "extensions." + extension));
            if (name != "extras") find_uses(inner, below(where, name), uses);
        }
    }
}

}  // namespace

bool is_extension_read(std::string_view name) {
    return std::ranges::find(read_names, name) != read_names.end();
}

bool is_extension_beside_the_picture(std::string_view name) {
    return std::ranges::any_of(beside_beginnings, [&](const char* beginning) { return name.starts_with(beginning); });
}

std::map<std::string, std::string> unread_extensions(const json& document) {
    std::map<std::string, std::string> found;
    find_uses(document, "", found);
    if (const auto used = document.find("extensionsUsed"); used != document.end() && used->is_array())
        for (const json& name : *used)
            if (name.is_string()) found.try_emplace(name.get<std::string>(), "extensionsUsed");
    std::erase_if(found, [](const auto& use) { return is_extension_read(use.first); });
    return found;
}

}  // namespace sheer
