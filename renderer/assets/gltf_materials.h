#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "renderer/assets/gltf_file.h"
#include "renderer/assets/gltf_pictures.h"
#include "renderer/scene/model.h"

namespace sheer {

/// The source of a picture's texture coordinates: an attribute, and its transform (KHR_texture_transform).
struct GltfUv {
    std::uint64_t set = 0;  ///< of TEXCOORD_<set>
    glm::dmat3x2 transform{1, 0, 0, 1, 0, 0};

    glm::dvec2 operator()(const glm::dvec2& at) const { return transform * glm::dvec3(at, 1); }
};

/// The materials of a glTF file that are in use, numbered in the order of first use. Throws AssetError.
class GltfMaterials {
  public:
    /// The file and the pictures outlive it.
    GltfMaterials(GltfFile& file, GltfPictures& pictures) : m_file(file), m_pictures(pictures) {}

    /// The number for a material of the file; without an index, for glTF's default material. `what` names its user.
    std::uint32_t use(std::optional<std::uint64_t> index, const std::string& what);

    const std::vector<Material>& materials() const { return m_materials; }
    const GltfUv& base_uv(std::uint32_t material) const { return m_base_uvs[material]; }
    const GltfUv& emission_uv(std::uint32_t material) const { return m_emission_uvs[material]; }

  private:
    void read_base(const GltfObject& from, Material& material, GltfUv& uv);
    void read_emission(const GltfObject& from, Material& material, GltfUv& uv);
    void read_transmission(const GltfObject& from, Material& material);
    void note_unread(const GltfObject& from);

    GltfFile& m_file;
    GltfPictures& m_pictures;
    std::map<std::optional<std::uint64_t>, std::uint32_t> m_numbers;  ///< by the index in the file
    std::vector<Material> m_materials;
    std::vector<GltfUv> m_base_uvs, m_emission_uvs;  ///< of the materials
    bool m_unread_noted = false;
};

}  // namespace sheer
