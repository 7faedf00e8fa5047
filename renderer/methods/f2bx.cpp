// The upper bound of early discarding: F2BX of Vlcek, Havel, Herout, SCCG 2010, section 3.
// F2BD with the transmittance cleared to 0, so that every fragment is discarded. Its time is the lowest that discarding
// could reach; its picture is black, since nothing shows through without transmittance, and has no error metrics.
// A `threshold` of 0 would discard nothing and is not allowed.
#include "renderer/methods/shared/discarding.h"

namespace sheer {

MethodInfo method_f2bx() {
    return describe_method(
        {
            .id = "f2bx",
            .name = "F2BX",
            .kind = "upper bound",
            .summary = "F2BD that discards every fragment: the most that early discarding could gain.",
            .paper =
                "Vlcek, Havel, Herout, Front-to-Back Blending with Early Fragment Discarding, SCCG 2010, section 3",
            .good_at = "Showing how much of a frame's time is shading.",
            .bad_at = "Its picture is black: it is for measuring, not for drawing.",
            .memory = "one pixel of the image format, and a quarter of it more with a separate alpha target",
            .passes = "1, and a full-screen one",
            .needs = "texture barriers or framebuffer fetch",
            .saturation_parameter = "threshold",
            .no_metrics_reason = "f2bx discards every transparent fragment by design; only its time is meaningful",
        },
        DiscardingParameters::table().with_min("threshold", 0.001),
        [](const MethodSetup& setup, const DiscardingParameters& parameters) {
            return std::make_unique<DiscardingBlending>(setup, parameters, 0.0f);
        },
        discarding_bytes_per_px);
}

}  // namespace sheer
