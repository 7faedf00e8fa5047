// Classical blending in the order of submission: what a renderer that does not sort shows. One of the alternatives that
// Hathaway discusses in "Alpha Blending as a Post-Process", GPU Pro (2010).
#include "renderer/methods/shared/classical_blending.h"

namespace sheer {

MethodInfo method_unsorted() {
    return describe_method(
        {
            .id = "unsorted",
            .name = "Unsorted",
            .kind = "unsorted blending",
            .summary = "Classical blending in submission order, without sorting.",
            .paper = "Hathaway, Alpha Blending as a Post-Process, GPU Pro, 2010 (an alternative discussed there)",
            .good_at = "No sorting and no extra memory; correct where nothing transparent overlaps.",
            .bad_at = "Overlapping primitives are blended in whatever order they were submitted.",
            .memory = "0 bytes per pixel",
            .passes = "1",
            .needs_sorting = false,
        },
        NoParameters::table(),
        [](const MethodSetup& setup, const NoParameters&) {
            return std::make_unique<ClassicalBlending>(setup, Order::submission);
        },
        pixels_and_bytes(0));
}

}  // namespace sheer
