#pragma once
#include <string>
#include <string_view>

#include "renderer/assets/voxel_layout.h"

namespace sheer {

/// The decoded bytes of the voxels in the order of the file; text becomes little-endian bytes.
/// `skip`: bytes before the first voxel, in a compressed stream after decompression; -1: the voxels are the last bytes.
/// Never uses more memory than the layout requires. Throws AssetError for damaged data, and for too little or too much.
std::string voxel_bytes(const VoxelLayout& layout, std::string_view data, int skip);

}  // namespace sheer
