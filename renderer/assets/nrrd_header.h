#pragma once
#include <glm/glm.hpp>
#include <string_view>

#include "renderer/scene/assets.h"

namespace sheer {

enum class VoxelType { uint8, int16, uint16, float32 };

/// How voxels lie in bytes.
struct VoxelLayout {
    glm::ivec3 size{0};  ///< 1..max_volume_side each
    glm::dvec3 spacing{1};
    VoxelType type = VoxelType::uint8;
    bool big_endian = false;
    bool gzip = false;
};

std::size_t bytes_of(VoxelType type);
/// "uint8", "int16", "uint16" or "float32".
const char* name_of(VoxelType type);

/// Whether a file begins as an NRRD file does.
bool is_nrrd(std::string_view bytes);

struct NrrdHeader {
    VoxelLayout layout;
    std::size_t data_begin;  ///< byte
};
/// Throws AssetError, see read_volume.
NrrdHeader read_nrrd_header(std::string_view bytes);

/// Throws AssetError for sides or a whole that are over the limits of read_volume.
void check_volume_size(const glm::ivec3& size, VoxelType type);

}  // namespace sheer
