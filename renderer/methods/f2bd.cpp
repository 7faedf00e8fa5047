// Front-to-back blending with early fragment discarding: F2BD of Vlcek, Havel, Herout, SCCG 2010, sections 2.1 and 2.2.
// As F2B, but a fragment first reads the remaining transmittance of its pixel from the very texture that is being drawn
// to, and is discarded before any shading if that is under `threshold`.
#include "renderer/methods/shared/discarding.h"

namespace sheer {

MethodInfo method_f2bd() {
    return describe_method(
        {
            .id = "f2bd",
            .name = "F2BD",
            .kind = "sorted blending with early discard",
            .summary =
                "F2B in which a fragment is discarded before shading if its pixel is already practically opaque.",
            .paper =
                "Vlcek, Havel, Herout, Front-to-Back Blending with Early Fragment Discarding, SCCG 2010, section 2.1",
            .good_at =
                "Heavy overdraw with costly shading; the error is at most the threshold times the brightest color.",
            .bad_at =
                "Few layers or cheap shading; still starts a shader for every fragment; feedback needs a barrier.",
            .memory = "one pixel of the image format, and a quarter of it more with a separate alpha target",
            .passes = "1, and a full-screen one",
            .needs = "texture barriers or framebuffer fetch",
            .saturation_parameter = "threshold",
        },
        DiscardingParameters::table(),
        [](const MethodSetup& setup, const DiscardingParameters& parameters) {
            return std::make_unique<DiscardingBlending>(setup, parameters, 1.0f);
        },
        discarding_bytes_per_px);
}

}  // namespace sheer
