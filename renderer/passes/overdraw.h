#pragma once
#include "renderer/image/pixel_counts.h"
#include "renderer/passes/target.h"

namespace sheer {

/// Transparent fragments that opaque geometry does not hide, counted in every pixel.
PixelCounts count_overdraw(const gl::Functions& gl, const Scene& scene, const Target& target, gl::FrameTimer& timer);
/// Those whose alpha is not 0.
PixelCounts count_visible(const gl::Functions& gl, const Scene& scene, const Target& target, gl::FrameTimer& timer);
/// All transparent fragments, as if there were no opaque geometry.
PixelCounts count_behind_opaque(const gl::Functions& gl, const Scene& scene, const Target& target,
                                gl::FrameTimer& timer);

}  // namespace sheer
