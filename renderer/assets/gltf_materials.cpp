#include "renderer/assets/gltf_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sheer {

namespace {

/// This much light is white whatever is drawn over it.
constexpr double max_emitted = 1e6;

Material::Alpha alpha_mode(const GltfObject& material) {
    const std::string name = material.text("alphaMode", "OPAQUE");
    if (name == "OPAQUE") return Material::Alpha::opaque;
    if (name == "MASK") return Material::Alpha::mask;
    if (name == "BLEND") return Material::Alpha::blend;
    material.fail(fmt::format("alphaMode must be OPAQUE, MASK or BLEND, not \"{:.40}\"", name));
}

/// Khronos, KHR_texture_transform: translation * rotation * scale; rotation is counter-clockwise because v points down.
GltfUv uv_of(const GltfObject& info) {
    GltfUv uv{info.whole_number("texCoord").value_or(0)};
    const auto transform = info.extension("KHR_texture_transform");
    if (!transform) return uv;
    uv.set = transform->whole_number("texCoord").value_or(uv.set);
    const std::vector<double> offset = transform->numbers("offset", 2), scale = transform->numbers("scale", 2);
    const double turn = transform->number("rotation", 0), c = std::cos(turn), s = std::sin(turn);
    const glm::dvec2 by = scale.empty() ? glm::dvec2(1) : glm::dvec2(scale[0], scale[1]);
    uv.transform[0] = glm::dvec2(c, -s) * by.x;
    uv.transform[1] = glm::dvec2(s, c) * by.y;
    if (!offset.empty()) uv.transform[2] = {offset[0], offset[1]};
    return uv;
}

/// Color, sRGB-encoded, and alpha.
glm::vec4 color_of(const GltfObject& from, const char* name) {
    const std::vector<double> factor = from.numbers(name, 4);
    if (factor.empty()) return glm::vec4(1);
    return {srgb_encode(factor[0]), srgb_encode(factor[1]), srgb_encode(factor[2]),
            static_cast<float>(std::clamp(factor[3], 0.0, 1.0))};
}

}  // namespace

std::uint32_t GltfMaterials::use(std::optional<std::uint64_t> index, const std::string& what) {
    const auto [known, added] = m_numbers.try_emplace(index, static_cast<std::uint32_t>(m_materials.size()));
    if (!added) return known->second;
    Material material;
    GltfUv base_uv, emission_uv;
    if (index) {
        const GltfObject from = m_file.item(gltf_lists::materials, *index, what);
        material.alpha = alpha_mode(from);
        material.cutoff =
            static_cast<float>(std::clamp(from.number("alphaCutoff", 0.5), 0.0, 2.0));  // over 1 hides all
        material.double_sided = from.flag("doubleSided");
        material.unlit = from.extension("KHR_materials_unlit").has_value();
        read_transmission(from, material);
        read_base(from, material, base_uv);
        if (!material.unlit) read_emission(from, material, emission_uv);
        note_unread(from);
    }
    m_materials.push_back(material);
    m_base_uvs.push_back(base_uv);
    m_emission_uvs.push_back(emission_uv);
    return known->second;
}

void GltfMaterials::read_base(const GltfObject& from, Material& material, GltfUv& uv) {
    const auto glossy = from.extension("KHR_materials_pbrSpecularGlossiness");
    const auto base = glossy ? glossy : from.object("pbrMetallicRoughness");
    if (!base) return;
    // The alpha of an otherwise opaque surface has been reduced by what glass lets through.
    const glm::vec4 color = color_of(*base, glossy ? "diffuseFactor" : "baseColorFactor");
    const bool alpha_counts = alpha_mode(from) != Material::Alpha::opaque;
    material.base_color = {glm::vec3(color), material.base_color.a * (alpha_counts ? color.a : 1)};
    const auto texture = base->object(glossy ? "diffuseTexture" : "baseColorTexture");
    if (!texture) return;
    material.base = m_pictures.use(*texture, alpha_counts ? GltfPictures::Alpha::kept : GltfPictures::Alpha::ignored);
    uv = uv_of(*texture);
}

void GltfMaterials::read_emission(const GltfObject& from, Material& material, GltfUv& uv) {
    const std::vector<double> factor = from.numbers("emissiveFactor", 3);
    const auto strength = from.extension("KHR_materials_emissive_strength");
    const double times = strength ? strength->number("emissiveStrength", 1) : 1;
    if (!(times >= 0)) strength->fail("emissiveStrength must be at least 0");
    for (int channel = 0; channel < 3 && !factor.empty(); ++channel)
        material.emitted[channel] =
            static_cast<float>(std::clamp(factor[static_cast<std::size_t>(channel)] * times, 0.0, max_emitted));
    const auto texture = from.object("emissiveTexture");
    if (!texture || material.emitted == glm::vec3(0)) return;
    material.emission = m_pictures.use(*texture, GltfPictures::Alpha::ignored);
    uv = uv_of(*texture);
}

void GltfMaterials::read_transmission(const GltfObject& from, Material& material) {
    const auto transmission = from.extension("KHR_materials_transmission");
    const double factor = transmission ? std::clamp(transmission->number("transmissionFactor", 0), 0.0, 1.0) : 0;
    if (factor == 0) return;
    m_file.note(
        "transmission-blended",
        fmt::format("KHR_materials_transmission is drawn as BLEND with alpha times {:g}; its tint, refraction{} "
                    "are ignored.",
                    1 - factor, transmission->has("transmissionTexture") ? ", blur and texture" : " and blur"),
        from.where());
    if (material.alpha == Material::Alpha::mask)
        m_file.note("mask-blended", "The mask's cutoff is ignored because the surface transmits light.", from.where());
    material.alpha = Material::Alpha::blend;
    material.base_color.a = static_cast<float>(1 - factor);
}

/// One note for all materials: nearly every file has such textures.
void GltfMaterials::note_unread(const GltfObject& from) {
    if (m_unread_noted) return;
    const auto metallic = from.object("pbrMetallicRoughness");
    std::string names;
    const auto add = [&](bool there, const char* name) {
        names += there ? (names.empty() ? "" : ", ") + std::string(name) : "";
    };
    add(from.has("normalTexture"), "normalTexture");
    add(from.has("occlusionTexture"), "occlusionTexture");
    add(metallic && metallic->has("metallicRoughnessTexture"), "metallicRoughnessTexture");
    if (names.empty()) return;
    m_unread_noted = true;
    m_file.note(
        "material-textures-ignored",
        fmt::format("Textures for bumps, shade and gloss ({} here) are ignored: a surface has its base color and "
                    "the light that it emits.",
                    names),
        from.where());
}

}  // namespace sheer
