#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "renderer/assets/voxel_layout.h"
#include "renderer/core/notes.h"
#include "renderer/scene/assets.h"

namespace sheer {

/// Whether a file begins as an NRRD file does.
bool is_nrrd(std::string_view bytes);

struct NrrdHeader {
    VoxelLayout layout;
    std::size_t data_begin = 0;  ///< first byte, if the data is attached
    std::string data_file;       ///< "" if the data is attached
    int line_skip = 0;           ///< lines before the data
    int byte_skip = 0;           ///< bytes before the voxels; -1: they are the last ones
    std::vector<Note> notes;     ///< what was read differently from the header
};
/// Throws AssetError, see read_volume.
NrrdHeader read_nrrd_header(std::string_view bytes);

/// Throws AssetError if the sides or the total size exceed the limits of read_volume.
void check_volume_size(const glm::ivec3& size, VoxelType type);

}  // namespace sheer
