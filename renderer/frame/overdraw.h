#pragma once
#include "renderer/frame/pixel_counts.h"
#include "renderer/frame/target.h"

namespace sheer {

/// Counts the transparent fragments of each pixel that opaque geometry does not hide. By additive blending in 32-bit
/// floats: exact up to 2^24 fragments per pixel. Draws the opaque pass first.
PixelCounts count_overdraw(const gl::Functions& gl, const Scene& scene, const Target& target, gl::FrameTimer& timer);

}  // namespace sheer
