#include "renderer/assets/gltf_materials.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/assets/picture_file.h"

namespace sheer {

namespace {

constexpr int max_side_px = 2048;
constexpr std::size_t max_texels = std::size_t{16} << 20, max_pictures = 1024;

Material::Alpha alpha_mode(const std::string& name, const std::string& what) {
    if (name.empty() || name == "OPAQUE") return Material::Alpha::opaque;
    if (name == "MASK") return Material::Alpha::mask;
    if (name == "BLEND") return Material::Alpha::blend;
    throw AssetError(fmt::format("{}: alphaMode must be OPAQUE, MASK or BLEND, not \"{:.40}\"", what, name));
}

/// The least power of two from `size` up, at most max_side_px.
int power_of_two(int size) {
    int power = 1;
    while (power < size && power < max_side_px) power *= 2;
    return power;
}

}  // namespace

std::uint32_t GltfMaterials::use(int index, const std::string& what) {
    const auto [known, added] = m_numbers.try_emplace(index, static_cast<std::uint32_t>(m_materials.size()));
    if (!added) return known->second;
    Material material;
    int uv_set = 0;
    if (index != -1) {
        if (index < 0 || static_cast<std::size_t>(index) >= m_gltf.materials.size())
            throw AssetError(fmt::format("{}: there is no material {}", what, index));
        material = read(m_gltf.materials[static_cast<std::size_t>(index)], fmt::format("material {}", index), uv_set);
    }
    m_materials.push_back(material);
    m_uv_sets.push_back(uv_set);
    return known->second;
}

Material GltfMaterials::read(const tinygltf::Material& from, const std::string& what, int& uv_set) {
    Material material;
    material.alpha = alpha_mode(from.alphaMode, what);
    material.cutoff = static_cast<float>(std::clamp(from.alphaCutoff, 0.0, 2.0));  // over 1 hides all
    const tinygltf::PbrMetallicRoughness& base = from.pbrMetallicRoughness;
    for (int channel = 0; channel < 3; ++channel)
        material.base_color[channel] = srgb_encode(base.baseColorFactor.at(static_cast<std::size_t>(channel)));
    material.base_color.a = static_cast<float>(std::clamp(base.baseColorFactor.at(3), 0.0, 1.0));
    if (base.baseColorTexture.index != -1) material.picture = use_picture(base.baseColorTexture.index, what);
    uv_set = base.baseColorTexture.texCoord;
    material.unlit = from.extensions.contains("KHR_materials_unlit");
    return material;
}

int GltfMaterials::use_picture(int texture, const std::string& what) {
    if (texture < 0 || static_cast<std::size_t>(texture) >= m_gltf.textures.size())
        throw AssetError(fmt::format("{}: there is no texture {}", what, texture));
    const int image = m_gltf.textures[static_cast<std::size_t>(texture)].source;
    if (image < 0 || static_cast<std::size_t>(image) >= m_gltf.images.size())
        throw AssetError(fmt::format("texture {}: there is no image {}", texture, image));
    const auto known = std::ranges::find(m_images, image);
    const auto number = static_cast<int>(known - m_images.begin());
    if (known == m_images.end()) m_images.push_back(image);
    if (m_images.size() > max_pictures)
        throw AssetError(fmt::format("the model has more than {} pictures", max_pictures));
    return number;
}

std::vector<Picture> GltfMaterials::read_pictures() const {
    std::vector<std::string> encoded;
    int width_px = 1, height_px = 1;
    for (const int image : m_images) {
        try {
            encoded.push_back(read_gltf_picture(m_gltf, m_gltf.images[static_cast<std::size_t>(image)], m_others));
            const PictureHeader header = read_picture_header(encoded.back());
            width_px = std::max(width_px, power_of_two(header.width_px));
            height_px = std::max(height_px, power_of_two(header.height_px));
        } catch (const AssetError& error) {
            throw AssetError(fmt::format("image {}: {}", image, error.what()));
        }
    }
    while (static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px) * encoded.size() > max_texels)
        (width_px > height_px ? width_px : height_px) /= 2;
    std::vector<Picture> pictures;
    for (std::size_t i = 0; i < encoded.size(); ++i) {
        try {
            pictures.push_back(read_picture(encoded[i], width_px, height_px));
        } catch (const AssetError& error) {
            throw AssetError(fmt::format("image {}: {}", m_images[i], error.what()));
        }
    }
    return pictures;
}

}  // namespace sheer
