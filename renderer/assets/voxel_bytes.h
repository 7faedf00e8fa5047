#pragma once
#include <string>
#include <string_view>

#include "renderer/assets/voxel_layout.h"

namespace sheer {

/// The voxels' bytes in the order of the file, out of their encoding; text becomes bytes that are little-endian.
/// `skip`: bytes before the first voxel, which a compressed stream has inside; -1: all but the last ones.
/// Never takes more memory than the layout says. Throws AssetError for damaged data, and for too little or too much.
std::string voxel_bytes(const VoxelLayout& layout, std::string_view data, int skip);

}  // namespace sheer
