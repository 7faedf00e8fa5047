#pragma once
#include <string>

#include "renderer/frame/pixel_counts.h"
#include "renderer/frame/target.h"

namespace sheer {

/// What the exact front-to-back order must shade.
struct NeededFragments {
    /// Fragments that find at least the threshold of the transmittance left.
    PixelCounts needed;
    /// Of pixels in which less than the threshold is left in the end, the number of the fragment that brought it there,
    /// from 1; elsewhere 0.
    PixelCounts saturation;
};

/// Why count_needed cannot tell it of this scene, whose count_overdraw is given; empty if it can.
std::string why_needed_is_unknown(const Scene& scene, const PixelCounts& overdraw);

/// Blends from near to far, with a texture barrier before each step, so that every fragment sees what all nearer ones
/// have left; nothing is discarded. A step is one primitive where primitives are parallel, else a peeled layer. The
/// transmittance is kept in the target's format, as a method's own is. Fragments that opaque geometry hides do not
/// count. Draws the opaque pass first.
NeededFragments count_needed(const gl::Functions& gl, const Scene& scene, const Target& target, float threshold,
                             gl::FrameTimer& timer);

}  // namespace sheer
