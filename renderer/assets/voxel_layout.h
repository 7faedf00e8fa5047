#pragma once
#include <array>
#include <cstddef>
#include <glm/glm.hpp>

namespace sheer {

enum class VoxelType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct VoxelKind {
    VoxelType type;
    const char* name;
    std::size_t bytes;
};
inline constexpr VoxelKind voxel_kinds[] = {
    {VoxelType::int8, "int8", 1},       {VoxelType::uint8, "uint8", 1},     {VoxelType::int16, "int16", 2},
    {VoxelType::uint16, "uint16", 2},   {VoxelType::int32, "int32", 4},     {VoxelType::uint32, "uint32", 4},
    {VoxelType::float32, "float32", 4}, {VoxelType::float64, "float64", 8},
};
inline const VoxelKind& kind_of(VoxelType type) {
    return voxel_kinds[static_cast<std::size_t>(type)];
}

enum class VoxelEncoding { raw, text, hex, gzip, bzip2 };

/// Where an axis of the file points in the scene, in which x goes right, y up and z towards the usual camera.
struct VoxelAxis {
    int scene_axis = 0;
    bool reversed = false;
};

/// How voxels are stored. Of the file's axes, the first is the fastest.
struct VoxelLayout {
    glm::ivec3 size{0};  ///< 1..max_volume_side each
    glm::dvec3 spacing{1};
    VoxelType type = VoxelType::uint8;
    VoxelEncoding encoding = VoxelEncoding::raw;
    bool big_endian = false;
    std::array<VoxelAxis, 3> axes{{{0}, {1}, {2}}};
};

}  // namespace sheer
