#pragma once
#include <cstdint>
#include <vector>

#include "renderer/frame/target.h"

namespace sheer {

/// How many transparent fragments each pixel gets that opaque geometry does not hide.
struct Overdraw {
    int width_px = 0;
    int height_px = 0;
    std::vector<std::uint32_t> counts;  ///< rows from the top down

    std::uint64_t total() const;
    std::uint32_t greatest() const;
    /// Fragments in the rectangle [x0, x1) x [y0, y1).
    std::uint64_t total_in(int x0, int y0, int x1, int y1) const;
};

/// Counts by additive blending in 32-bit floats: exact up to 2^24 fragments per pixel. Draws the opaque pass first.
Overdraw count_overdraw(const gl::Functions& gl, const Scene& scene, const Target& target, gl::FrameTimer& timer);

}  // namespace sheer
