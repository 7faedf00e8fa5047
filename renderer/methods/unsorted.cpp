// Classical blending in the order of submission: what a renderer that does not sort shows. One of the alternatives that
// Hathaway weighs in "Alpha Blending as a Post-Process", GPU Pro (2010).
// Good at: no sorting, no memory. Bad at: wrong wherever two transparent primitives overlap in the wrong order.
// No parameters.
#include "renderer/frame/classical_blending.h"

namespace sheer {

MethodInfo method_unsorted() {
    return {
        .id = "unsorted",
        .name = "Unsorted",
        .kind = "unsorted blending",
        .summary = "Classical blending in submission order, without sorting.",
        .paper = "Hathaway, Alpha Blending as a Post-Process, GPU Pro, 2010 (an alternative weighed there)",
        .good_at = "No sorting and no extra memory; right where nothing transparent overlaps.",
        .bad_at = "Overlapping primitives show through in whatever order they were submitted.",
        .memory = "0 bytes per pixel",
        .needs_sorting = false,
        .make = [](const MethodSetup& setup) -> std::unique_ptr<Method> {
            return std::make_unique<ClassicalBlending>(setup, Order::submission);
        },
    };
}

}  // namespace sheer
