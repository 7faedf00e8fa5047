#include "tests/render/method_row.h"

namespace sheer::test {

MethodRow row_dual_depth_peeling() {
    return {
        .id = "dual_depth_peeling",
        .formula = [](const nlohmann::json&) -> Formula { return over_by_depth; },
        .variants = {{nlohmann::json::object()}},
        .litmus =
            {{"",
              {nlohmann::json::object()},
              {{{"shuffled"}, passes, "layers are taken by their depths, whatever the order was"},
               {{"overflow"}, passes, "it sums nothing that could overflow; of one color, the layers have no order"},
               {{"self_overlap"}, passes, "it sorts the fragments of each pixel, not primitives"},
               {{"fade"},
                fails,
                "the inside of a model shows, as of any layers of that alpha: it does not know that they are one "
                "model"},
               {{"black", "white", "checker", "alpha_to_0", "alpha_to_1", "one_layer", "64_layers", "unequal", "window",
                 "close_pair", "interleaved"},
                passes,
                "every layer is taken once, from one of the two sides, and composited in 32 bits"},
               {{"opaque_front", "opaque_behind", "opaque_between"},
                passes,
                "each pass is tested against the opaque depth"},
               {{"glass", "leaves"}, passes, "it takes the layers of each pixel, not primitives"}}}},
    };
}

}  // namespace sheer::test
