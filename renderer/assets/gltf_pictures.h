#pragma once
#include <utility>
#include <vector>

#include "renderer/assets/gltf_file.h"
#include "renderer/scene/model.h"

namespace sheer {

/// The pictures of a model that are in use, each once, or twice if one surface reads its alpha and another ignores it.
/// The file outlives it. All functions throw AssetError.
class GltfPictures {
  public:
    explicit GltfPictures(GltfFile& file) : m_file(file) {}

    enum class Alpha { kept, ignored };
    /// How a surface reads the texture that `info` (a material's baseColorTexture) refers to.
    PictureUse use(const GltfObject& info, Alpha alpha);

    /// Decodes the pictures, in sizes that fit into the array textures.
    std::vector<Picture> read();

  private:
    struct Wanted {
        std::uint64_t image;
        Alpha alpha;
        bool operator==(const Wanted&) const = default;
    };
    std::uint64_t image_of(const GltfObject& texture);
    void read_sampler(const GltfObject& sampler, PictureUse& use) const;

    GltfFile& m_file;
    std::vector<Wanted> m_wanted;
};

}  // namespace sheer
