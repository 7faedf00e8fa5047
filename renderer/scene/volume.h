#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "renderer/core/notes.h"

namespace sheer {

/// Scalars on a grid, x fastest, then y, then z.
struct Volume {
    glm::ivec3 size{0};               ///< voxels along each axis
    glm::dvec3 spacing{1};            ///< from voxel to voxel; only their ratios matter
    std::vector<std::uint8_t> bytes;  ///< empty where `floats` holds the voxels
    std::vector<float> floats;        ///< the values themselves: 0..1, or beyond if a range excludes them
    glm::dvec2 byte_range{0, 255};    ///< the bytes that stand for 0 and 1; they differ
    std::vector<Note> notes;          ///< what was not read from the file, or read differently

    std::size_t voxel_count() const {
        return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z);
    }
    /// Of the whole, scaled so that the longest side is 1.
    glm::dvec3 sides() const {
        const glm::dvec3 whole = spacing * glm::dvec3(size);
        return whole / glm::max(whole.x, glm::max(whole.y, whole.z));
    }
};

/// A head that faces along z with y up: skin, flesh, skull, teeth, brain, eyes and airways, each with a value of its
/// own. `size` voxels a side, which are not cubes because the box fits the head. The same on every platform.
Volume make_head(int size);

/// The values of the materials of make_head.
struct HeadValues {
    static constexpr float air = 0, skin = 0.2f, brain = 0.36f, flesh = 0.5f, eye = 0.6f, bone = 0.85f, tooth = 1;
};

}  // namespace sheer
