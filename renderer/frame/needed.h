#pragma once
#include <string>

#include "renderer/frame/pixel_counts.h"
#include "renderer/frame/target.h"

namespace sheer {

/// What the exact front-to-back order must shade of a scene whose primitives are parallel.
struct NeededFragments {
    /// Fragments that find at least the threshold of the transmittance left.
    PixelCounts needed;
    /// Of pixels in which less than the threshold is left in the end, the number of the fragment that brought it there,
    /// from 1; elsewhere 0.
    PixelCounts saturation;
};

/// Why count_needed cannot tell it of this scene; empty if it can.
std::string why_needed_is_unknown(const Scene& scene);

/// Blends from near to far, primitive by primitive with a texture barrier between, so that every fragment sees what all
/// nearer ones have left; nothing is discarded. The transmittance is kept in the target's format, as a method's own is.
/// For scenes of which it can tell. Fragments that opaque geometry hides do not count. Draws the opaque pass first.
NeededFragments count_needed(const gl::Functions& gl, const Scene& scene, const Target& target, float threshold,
                             gl::FrameTimer& timer);

}  // namespace sheer
