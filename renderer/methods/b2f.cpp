// Back-to-front blending, the classical way: B2F of Vlcek, Havel, Herout, SCCG 2010, equation (1).
// Opaque geometry first, then the transparent primitives from far to near with SRC_ALPHA, ONE_MINUS_SRC_ALPHA.
#include "renderer/methods/shared/classical_blending.h"

namespace sheer {

MethodInfo method_b2f() {
    return describe_method(
        {
            .id = "b2f",
            .name = "B2F",
            .kind = "sorted blending",
            .summary = "Classical blending from far to near, straight into the picture.",
            .paper =
                "Vlcek, Havel, Herout, Front-to-Back Blending with Early Fragment Discarding, SCCG 2010, equation (1)",
            .good_at = "No extra memory or passes; correct if primitives do not intersect.",
            .bad_at =
                "Shades every fragment, even those that nearer ones will hide; 8-bit targets round once per layer.",
            .memory = "0 bytes per pixel",
            .passes = "1",
        },
        NoParameters::table(),
        [](const MethodSetup& setup, const NoParameters&) {
            return std::make_unique<ClassicalBlending>(setup, Order::far_to_near);
        },
        pixels_and_bytes(0));
}

}  // namespace sheer
