#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "renderer/scene/picture.h"

namespace sheer {

/// How a surface of a model is drawn. All colours are display values, as in pictures: what a file gives in linear light
/// has been encoded (srgb_encode) by its reader.
struct Material {
    enum class Alpha { opaque, mask, blend };

    Alpha alpha = Alpha::opaque;
    float cutoff = 0.5f;  ///< of a mask: fragments of less alpha are not there
    glm::vec4 base_color{1};
    int picture = -1;  ///< index into Model::pictures, multiplied with the colours; -1 for none
    bool unlit = false;
};

struct ModelVertex {
    glm::vec3 position;  ///< in the model's own space, after all transforms of its file; right-handed, y up
    glm::vec3 normal;    ///< of length 1, or 0 where there is none
    glm::vec2 uv;        ///< v down; pictures repeat
    glm::vec4 color;     ///< multiplied with the material's
};

/// Triangles of one material.
struct ModelPart {
    std::vector<ModelVertex> vertices;
    std::vector<std::uint32_t> indices;  ///< triangles, each index within the vertices
    std::uint32_t material = 0;          ///< index into Model::materials
};

/// A mesh from a file, checked: all numbers are finite, all indices lie within what they point into, and there is at
/// least one triangle.
struct Model {
    std::vector<ModelPart> parts;
    std::vector<Material> materials;
    std::vector<Picture> pictures;  ///< all of one size; width and height are powers of two
    std::vector<Note> notes;        ///< what of the file was not read, or read otherwise
};

/// Linear light 0..1 as the display value that stands for it (IEC 61966-2-1); outside of 0..1 it is clamped.
float srgb_encode(double linear);

}  // namespace sheer
