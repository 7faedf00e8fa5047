#pragma once
#include <array>
#include <cstdint>

namespace sheer {

using ColorMap = std::array<std::array<std::uint8_t, 3>, 256>;

/// Magma by Smith and van der Walt (matplotlib, CC0): sRGB by level, from black over purple and orange to pale yellow.
/// Interpolated from every fifth level of the original, and within 1/255 of it.
const ColorMap& magma();

/// The largest count that still has a color of its own, counting from 0.
inline constexpr std::uint32_t most_counts_in_colors = 255;

}  // namespace sheer
