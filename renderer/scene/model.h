#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "renderer/scene/picture.h"

namespace sheer {

/// How a surface reads a picture (glTF 2.0, section 3.8.4). If the file does not say, it is repeated and filtered
/// trilinearly.
struct PictureUse {
    enum class Wrap { repeat, clamp, mirror };
    enum class Mipmaps { none, nearest, linear };

    int picture = -1;  ///< index into Model::pictures; -1 for none
    Wrap wrap_s = Wrap::repeat, wrap_t = Wrap::repeat;
    bool nearest_when_magnified = false, nearest_when_minified = false;
    Mipmaps mipmaps = Mipmaps::linear;

    bool operator==(const PictureUse&) const = default;
};

/// Bits 0-1 and 2-3: how s and t wrap; bit 4: whether a magnified picture is read at the nearest texel; bit 5: the same
/// for a minified one; bits 6-7: how mipmaps are filtered. Values are in the order of the enumerators.
/// (shaders/scenes/material.glsl.)
std::int32_t sampling_bits(const PictureUse& use);

/// How a surface of a model is drawn. Colors are display values, as in pictures: linear values of a file have been
/// encoded by its reader (srgb_encode). Only emitted light is linear, because it is added.
struct Material {
    enum class Alpha { opaque, mask, blend };

    Alpha alpha = Alpha::opaque;
    float cutoff = 0.5f;  ///< of a mask: fragments with less alpha are not drawn
    glm::vec4 base_color{1};
    PictureUse base;       ///< multiplied with the colors
    glm::vec3 emitted{0};  ///< linear light, may pass 1
    PictureUse emission;   ///< multiplied with the emitted light; its alpha is ignored
    bool unlit = false;
    bool double_sided = false;  ///< otherwise triangles are visible only from their front
};

struct ModelVertex {
    glm::vec3 position;  ///< from Model::origin, after all transforms of the file; right-handed, y up
    glm::vec3 normal;    ///< of length 1, or 0 where there is none
    glm::vec2 uv;        ///< of the material's base; v down
    glm::vec4 color;     ///< multiplied with the material's
    glm::vec2 emission_uv{0};
};

/// Triangles of one material.
struct ModelPart {
    std::vector<ModelVertex> vertices;
    std::vector<std::uint32_t>
        indices;                 ///< triangles, counter-clockwise from the front, each index within the vertices
    std::uint32_t material = 0;  ///< index into Model::materials
};

/// A mesh from a file that has been checked: all numbers are finite, all indices are in range, and there is at least
/// one triangle.
struct Model {
    std::vector<ModelPart> parts;
    std::vector<Material> materials;
    std::vector<Picture> pictures;  ///< of sizes that arrange_pictures leaves as they are
    glm::dvec3 origin{
        0};  ///< in the file's space; the middle of the model, so that positions keep their precision as floats
    std::vector<Note> notes;  ///< what was not read from the file, or read differently
};

/// Linear light 0..1 as the display value that stands for it (IEC 61966-2-1); outside of 0..1 it is clamped.
float srgb_encode(double linear);

}  // namespace sheer
