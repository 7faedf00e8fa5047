// A cap on the layers of a pixel: "Drawing in Reverse", blog article of 26 September 2007.
// Front to back, a stencil test lets the first `layers` fragments of a pixel through; fragments under `min_alpha` are
// dropped before they count. Where the cap was reached, what lies behind is guessed: a copy of the previous frame, at
// half the size by mipmapping, is drawn as the last, rearmost layer, which matters where coverage is still low. With
// accumulated colour A and transmittance T the picture of an even area goes A + T P(n-1), to A / (1 - T): it converges
// by the factor T a frame, to a picture that is right only where what is hidden looks like what is before it.
// The first frame has no previous one; the opaque picture shows through it. Where the cap hides nothing, a pixel keeps
// what is behind it: one of just `layers` fragments too. Which fragments the cap hides is told by the stencil, or, with
// early tests and opaque geometry or zcull, by a pass that counts fragments without shading them.
// `zcull`: a pass of a quarter of the width and height first keeps the depth of the `layers`-th fragment, and two
// triangles for each of its pixels prime the depth buffer, so that whole groups of fragments behind it fail at once. A
// coarse pixel decides for 4 x 4: where fewer fragments than at its middle lie before that depth, some are lost.
// With the alpha test a fragment must be shaded before it may count, so that a driver need not stop it early; with
// `min_alpha` 0 the stencil test comes before the shader.
// Good at: haze and smoke of very many faint layers; the time is bounded. Bad at: sharp things behind the cap are lost,
// colours drift from the truth, and the picture needs some frames to settle.
// Parameters: `layers` 1..254, 8; `min_alpha` 0..1, 0.02; `frames` 1..1000, 30; `zcull`, off.
#include "renderer/frame/stencil_cap.h"

namespace sheer {

MethodInfo method_stencil_cap() {
    return {
        .id = "stencil_cap",
        .name = "Stencil cap",
        .kind = "sorted blending, approximate",
        .summary = "F2B of the nearest few fragments of each pixel; the blurred previous frame stands for the rest.",
        .paper = "Drawing in Reverse, 2007-09-26",
        .good_at = "Haze of very many faint layers: no pixel is ever blended more than a few times.",
        .bad_at =
            "What lies behind the cap is guessed and settles over frames; a min_alpha over 0 may cost the early "
            "stencil test.",
        .memory =
            "3.5 pixels of the image format, 8 bytes of depth and stencil, half a byte more with zcull; with min_alpha "
            "0 and "
            "opaque geometry or zcull 2 bytes more",
        .parameters = stencil_cap_parameters(),
        .make = [](const MethodSetup& setup) -> std::unique_ptr<Method> { return std::make_unique<StencilCap>(setup); },
    };
}

}  // namespace sheer
