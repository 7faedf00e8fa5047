#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "renderer/assets/gltf_file.h"
#include "renderer/scene/model.h"

namespace sheer {

/// The materials of a glTF file that are in use, numbered as they are first met, and the pictures of their base
/// colours.
class GltfMaterials {
  public:
    /// `gltf` is what read_gltf_file gave; both outlive it.
    GltfMaterials(const tinygltf::Model& gltf, const OtherFiles& others) : m_gltf(gltf), m_others(others) {}

    /// The number here of the file's material `index`; -1 is glTF's default material. `what` names who uses it.
    /// Throws AssetError.
    std::uint32_t use(int index, const std::string& what);

    const std::vector<Material>& materials() const { return m_materials; }
    /// Number of the texture coordinates that the picture of a material goes by.
    int uv_set(std::uint32_t material) const { return m_uv_sets[material]; }

    /// Decodes the pictures of the materials in use, scaled to one size. Throws AssetError.
    std::vector<Picture> read_pictures() const;

  private:
    Material read(const tinygltf::Material& material, const std::string& what, int& uv_set);
    int use_picture(int texture, const std::string& what);

    const tinygltf::Model& m_gltf;
    const OtherFiles& m_others;
    std::map<int, std::uint32_t> m_numbers;  ///< by the index in the file
    std::vector<Material> m_materials;
    std::vector<int> m_uv_sets;  ///< of the materials
    std::vector<int> m_images;   ///< of the pictures, in the file
};

}  // namespace sheer
