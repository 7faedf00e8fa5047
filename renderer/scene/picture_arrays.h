#pragma once
#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

namespace sheer {

/// How the pictures of a model lie in array textures. A picture keeps its own size where it can: it has an array of
/// pictures of that size, or lies in one of larger pictures at the mipmap level that has its size.
struct PictureArrays {
    struct Array {
        glm::ivec2 size_px;
        int layers = 0;
    };
    struct Place {
        int array = 0;
        int layer = 0;
        int level = 0;  ///< that holds the picture itself; its mipmaps follow, the levels before are not used
    };
    std::vector<Array> arrays;
    std::vector<Place> places;         ///< of the pictures
    std::vector<glm::ivec2> sizes_px;  ///< of the pictures as they are stored; some are scaled
};

inline constexpr std::size_t max_picture_arrays = 5;
inline constexpr int max_model_picture_side_px = 2048;
inline constexpr std::size_t max_model_texels = std::size_t{16} << 20;

/// For pictures of these sizes, at least 1 a side. Those larger than max_model_picture_side_px are halved until they
/// fit, and the largest are halved while all layers together have more than max_model_texels. Sizes that have been
/// arranged once are not scaled when they are arranged again.
PictureArrays arrange_pictures(std::vector<glm::ivec2> sizes_px);

}  // namespace sheer
