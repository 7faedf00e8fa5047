// Back-to-front blending, the classical way: B2F of Vlcek, Havel, Herout, SCCG 2010, equation (1).
// Opaque geometry first, then the transparent primitives from far to near with SRC_ALPHA, ONE_MINUS_SRC_ALPHA.
// Good at: needs nothing but the target, exact where primitives do not intersect. Bad at: shades every fragment, also
// those that end up invisible. No parameters.
#include "renderer/frame/classical_blending.h"

namespace sheer {

MethodInfo method_b2f() {
    return {
        .id = "b2f",
        .name = "B2F",
        .kind = "sorted blending",
        .summary = "Classical blending from far to near, straight into the picture.",
        .paper = "Vlcek, Havel, Herout, Front-to-Back Blending with Early Fragment Discarding, SCCG 2010, equation (1)",
        .good_at = "No extra memory or passes; right wherever primitives do not intersect.",
        .bad_at = "Shades every fragment, also those that nearer ones will hide; 8-bit targets round once per layer.",
        .memory = "0 bytes per pixel",
        .make = [](const MethodSetup& setup) -> std::unique_ptr<Method> {
            return std::make_unique<ClassicalBlending>(setup, Order::far_to_near);
        },
    };
}

}  // namespace sheer
