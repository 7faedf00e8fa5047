#pragma once
#include <array>
#include <cstdint>

namespace sheer {

using ColourMap = std::array<std::array<std::uint8_t, 3>, 256>;

/// Magma by Smith and van der Walt (matplotlib, CC0): sRGB by level, from black over purple and orange to pale yellow.
/// Within 1/255 of the original, between whose every fifth level it interpolates.
const ColourMap& magma();

}  // namespace sheer
