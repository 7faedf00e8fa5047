#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "renderer/assets/voxel_layout.h"
#include "renderer/core/notes.h"

namespace sheer {

/// What an NRRD header says about its axes: the texts of its fields, or nothing for fields that it does not have.
struct NrrdAxisFields {
    std::optional<std::string_view> space, space_directions, spacings;
};

/// Sets spacing and axes. Directions are those of the scene: the space's x to the right, y up, z towards the usual
/// camera; in a left-handed space the first axis is reversed, so that nothing is mirrored. Axes that are oblique to the
/// space are placed along the nearest of its axes, with a note.
/// Throws AssetError for directions that are not three by three numbers, are in one plane, or have unusable lengths.
void place_nrrd_axes(const NrrdAxisFields& fields, VoxelLayout& layout, std::vector<Note>& notes);

}  // namespace sheer
