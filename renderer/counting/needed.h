#pragma once
#include <string>

#include "renderer/image/pixel_counts.h"
#include "renderer/passes/target.h"

namespace sheer {

/// The fragments that an exact front-to-back order must shade.
struct NeededFragments {
    /// Fragments that find at least the threshold of the transmittance left.
    PixelCounts needed;
    /// For pixels in which less than the threshold is left in the end, the number, from 1, of the fragment that brought
    /// it there; elsewhere 0.
    PixelCounts saturation;
};

/// Why count_needed cannot count this scene, whose count_overdraw is given; empty if it can.
std::string why_needed_is_unknown(const Scene& scene, const PixelCounts& overdraw);

/// Blends from near to far, with a texture barrier before each step, so that every fragment sees what all nearer ones
/// have left; nothing is discarded. A step is one primitive if primitives are parallel, otherwise a peeled layer. The
/// transmittance is kept in the target's format, as a method's own is. Fragments that opaque geometry hides do not
/// count. Draws the opaque pass first.
NeededFragments count_needed(const gl::Functions& gl, const Scene& scene, const Target& target, float threshold,
                             gl::FrameTimer& timer);

}  // namespace sheer
