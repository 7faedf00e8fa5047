#pragma once
#include <cstdint>
#include <vector>

#include "renderer/image/image.h"

namespace sheer {

/// A number for each pixel: how many fragments of some kind it has.
struct PixelCounts {
    int width_px = 0;
    int height_px = 0;
    std::vector<std::uint32_t> counts;  ///< rows from the top down

    std::uint64_t total() const;
    std::uint32_t greatest() const;
    /// The sum over the rectangle [x0, x1) x [y0, y1).
    std::uint64_t total_in(int x0, int y0, int x1, int y1) const;
};

/// As a picture in magma: black is 0, the palest yellow `full_scale` and above.
Image8 count_picture(const PixelCounts& counts, std::uint32_t full_scale);

}  // namespace sheer
