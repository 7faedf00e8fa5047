// A cap on the layers of a pixel: "Drawing in Reverse", blog article of 26 September 2007.
// Front to back, a stencil test lets the first `layers` fragments of a pixel through; fragments under `min_alpha` are
// dropped before they count. Where the cap was reached, what lies behind is guessed: a copy of the previous frame, at
// half the size by mipmapping, is drawn as the last, rearmost layer, which matters where coverage is still low. With
// accumulated color A and transmittance T, the picture of a uniform area is A + T P(n-1) and tends to A / (1 - T): it
// converges by the factor T per frame, to a picture that is correct only if what is hidden looks like what hides it.
// The first frame has no previous one; the opaque picture shows through it. A pixel in which the cap hides nothing
// keeps what is behind it, even if it has exactly `layers` fragments. The stencil shows which fragments the cap hides,
// or, with early tests and opaque geometry or zcull, a pass that counts fragments without shading them. `zcull`: a pass
// of a quarter of the width and height first keeps the depth of the `layers`-th fragment, and two triangles for each of
// its pixels prime the depth buffer, so that whole groups of fragments behind it fail at once. A coarse pixel decides
// for 4 x 4: where fewer fragments than at its middle lie in front of that depth, some are lost. With the alpha test a
// fragment must be shaded before it may count, so a driver need not stop it early; with `min_alpha` 0 the stencil test
// comes before the shader.
#include "renderer/methods/shared/stencil_cap.h"

namespace sheer {

MethodInfo method_stencil_cap() {
    return describe_method(
        {
            .id = "stencil_cap",
            .name = "Stencil cap",
            .kind = "sorted blending, approximate",
            .summary = "F2B of the nearest few fragments of each pixel; the blurred previous frame replaces the rest.",
            .paper = "Drawing in Reverse, 2007-09-26",
            .good_at = "Haze of very many faint layers: no pixel is ever blended more than a few times.",
            .bad_at =
                "What lies behind the cap is guessed and settles over several frames; a min_alpha over 0 may prevent "
                "the early stencil test.",
            .memory = "3.5 pixels of the image format, 8 bytes of depth and stencil, half a byte more with zcull; with "
                      "min_alpha "
                      "0 and "
                      "opaque geometry or zcull 2 bytes more",
            .passes = "1, and a full-screen one; another to count fragments or for zcull",
            .needs = "stencil",
        },
        StencilCapParameters::table(), make_new<StencilCap>,
        [](const StencilCapParameters& parameters, int pixel_bytes) -> std::optional<double> {
            const bool counts = parameters.zcull && parameters.min_alpha == 0;
            return 3.5 * pixel_bytes + 8 + (parameters.zcull ? 0.5 : 0) + (counts ? 2 : 0);
        });
}

}  // namespace sheer
