#pragma once
#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>

#include "renderer/assets/voxel_layout.h"

namespace sheer {

/// Calls `work` with a 0 of the type.
template <typename Work>
auto visit_voxel_type(VoxelType type, const Work& work) {
    switch (type) {
        case VoxelType::int8:
            return work(std::int8_t{});
        case VoxelType::uint8:
            return work(std::uint8_t{});
        case VoxelType::int16:
            return work(std::int16_t{});
        case VoxelType::uint16:
            return work(std::uint16_t{});
        case VoxelType::int32:
            return work(std::int32_t{});
        case VoxelType::uint32:
            return work(std::uint32_t{});
        case VoxelType::float32:
            return work(float{});
        case VoxelType::float64:
            return work(double{});
    }
    throw std::logic_error("unknown type of voxel");
}

/// The number stored at `bytes`.
template <typename Number>
Number voxel_at(const char* bytes, bool big_endian) {
    char voxel[sizeof(Number)];
    std::memcpy(voxel, bytes, sizeof(Number));
    if (big_endian != (std::endian::native == std::endian::big)) std::reverse(std::begin(voxel), std::end(voxel));
    Number number;
    std::memcpy(&number, voxel, sizeof(Number));
    return number;
}

template <typename Number>
void append_little_endian(std::string& bytes, Number number) {
    char voxel[sizeof(Number)];
    std::memcpy(voxel, &number, sizeof(Number));
    if (std::endian::native == std::endian::big) std::reverse(std::begin(voxel), std::end(voxel));
    bytes.append(voxel, sizeof(Number));
}

}  // namespace sheer
