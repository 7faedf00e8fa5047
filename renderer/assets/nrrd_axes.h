#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "renderer/assets/voxel_layout.h"
#include "renderer/notes.h"

namespace sheer {

/// What an NRRD header says of its axes: texts of its fields, none where it has no such field.
struct NrrdAxisFields {
    std::optional<std::string_view> space, space_directions, spacings;
};

/// Sets spacing and axes. Directions are those of the scene: the space's x to the right, y up, z towards the usual
/// camera; in a left-handed space the first axis is turned round, so that nothing is mirrored. Axes that are oblique to
/// the space lie along the nearest of its axes, with a note.
/// Throws AssetError for directions that are not three by three numbers, in one plane, or of unusable lengths.
void place_nrrd_axes(const NrrdAxisFields& fields, VoxelLayout& layout, std::vector<Note>& notes);

}  // namespace sheer
