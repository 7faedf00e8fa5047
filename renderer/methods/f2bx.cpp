// The upper bound of early discarding: F2BX of Vlcek, Havel, Herout, SCCG 2010, section 3.
// F2BD with the transmittance cleared to 0, so that every fragment is discarded. Its time is what discarding could gain
// at most; its picture is black, since nothing shows through where no transmittance is left, and has no error metrics.
// Parameters: those of F2BD; a `threshold` of 0 would discard nothing and is not allowed.
#include "renderer/frame/discarding.h"

namespace sheer {

namespace {

std::vector<Param> parameters() {
    std::vector<Param> all = discarding_parameters();
    for (Param& param : all)
        if (param.name == "threshold") param.min = 0.001;
    return all;
}

}  // namespace

MethodInfo method_f2bx() {
    return {
        .id = "f2bx",
        .name = "F2BX",
        .kind = "upper bound",
        .summary = "F2BD that discards every fragment: the most that early discarding could gain.",
        .paper = "Vlcek, Havel, Herout, Front-to-Back Blending with Early Fragment Discarding, SCCG 2010, section 3",
        .good_at = "Telling how much of a frame's time the shading is.",
        .bad_at = "Its picture is black: it is a measuring rod, not a way to draw.",
        .memory = "one pixel of the image format, and a quarter of it more with a separate alpha target",
        .parameters = parameters(),
        .no_metrics_reason = "f2bx discards every transparent fragment by design; only its time means something",
        .make = [](const MethodSetup& setup) -> std::unique_ptr<Method> {
            return std::make_unique<DiscardingBlending>(setup, 0.0f);
        },
    };
}

}  // namespace sheer
