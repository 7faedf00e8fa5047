#pragma once
#include <array>
#include <cstdint>

namespace sheer {

using ColourMap = std::array<std::array<std::uint8_t, 3>, 256>;

/// Magma by Smith and van der Walt (matplotlib, CC0): sRGB by level, from black over purple and orange to pale yellow.
/// Within 1/255 of the original, between whose every fifth level it interpolates.
const ColourMap& magma();

/// Most that can be counted in colours, from 0 on, if each count is to have its own.
inline constexpr std::uint32_t most_counts_in_colours = 255;

}  // namespace sheer
