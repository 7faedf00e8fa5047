#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "renderer/notes.h"

namespace sheer {

/// Scalars on a grid, x fastest, then y, then z.
struct Volume {
    glm::ivec3 size{0};               ///< voxels along each axis
    glm::dvec3 spacing{1};            ///< from voxel to voxel; only their ratios matter
    std::vector<std::uint8_t> bytes;  ///< empty where `floats` holds the voxels
    std::vector<float> floats;        ///< worth what they are: 0..1, and beyond where a range leaves them out
    glm::dvec2 byte_range{0, 255};    ///< the bytes that are worth 0 and 1; they differ
    std::vector<Note> notes;          ///< what of the file was not read, or read otherwise

    std::size_t voxel_count() const {
        return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z);
    }
    /// Of the whole, scaled so that the longest side is 1.
    glm::dvec3 sides() const {
        const glm::dvec3 whole = spacing * glm::dvec3(size);
        return whole / glm::max(whole.x, glm::max(whole.y, whole.z));
    }
};

/// A head that looks along z with y up: skin, flesh, skull, teeth, brain, eyes and airways, each with a value of its
/// own. `size` voxels a side; they are not cubes, for the box hugs the head. The same on every platform.
Volume make_head(int size);

/// What the materials of make_head are worth.
struct HeadValues {
    static constexpr float air = 0, skin = 0.2f, brain = 0.36f, flesh = 0.5f, eye = 0.6f, bone = 0.85f, tooth = 1;
};

}  // namespace sheer
