// Front-to-back blending with early fragment discarding: F2BD of Vlcek, Havel, Herout, SCCG 2010, sections 2.1 and 2.2.
// As F2B, but a fragment first reads the transmittance that is left at its pixel, from the very texture that is being
// drawn to, and gives up before any shading where that is under `threshold`.
// Good at: heavy overdraw with costly shaders. Bad at: light scenes; the error grows with the threshold.
// Parameters: `threshold` 0..1, 0.01; `sync` barrier, rebind, flush, finish or none; `alpha_target` shared or separate;
// `feedback` texture or framebuffer_fetch; `batch` primitives between synchronisations, 0 for one after the clear only;
// `form` if_else or if_discard; and those of F2B.
#include "renderer/frame/discarding.h"

namespace sheer {

MethodInfo method_f2bd() {
    return {
        .id = "f2bd",
        .name = "F2BD",
        .kind = "sorted blending with early discard",
        .summary = "F2B in which a fragment gives up before shading where the pixel is already as good as opaque.",
        .paper = "Vlcek, Havel, Herout, Front-to-Back Blending with Early Fragment Discarding, SCCG 2010, section 2.1",
        .good_at = "Heavy overdraw with costly shading; the error is at most the threshold times the brightest colour.",
        .bad_at = "Few layers or cheap shading; still starts a shader for every fragment; feedback needs a barrier.",
        .memory = "one pixel of the image format, and a quarter of it more with a separate alpha target",
        .parameters = discarding_parameters(),
        .make = [](const MethodSetup& setup) -> std::unique_ptr<Method> {
            return std::make_unique<DiscardingBlending>(setup, 1.0f);
        },
    };
}

}  // namespace sheer
