#include "tests/render/method_row.h"

namespace sheer::test {

MethodRow row_exact() {
    return {
        .id = "exact",
        .formula = [](const nlohmann::json&) -> Formula { return over_by_depth; },
        .variants = {{{{"form", "lists"}}}, {{{"form", "sorted"}}}},
        .litmus =
            {{"",
              {{{"form", "lists"}}, nlohmann::json::object()},
              {{{"shuffled"}, passes, "the fragments of a pixel are sorted, whatever their order was"},
               {{"overflow"}, passes, "it sums nothing that could overflow; of one color, the layers have no order"},
               {{"self_overlap"}, passes, "it sorts the fragments of each pixel, not primitives"},
               {{"fade"},
                fails,
                "the inside of a model shows, as of any layers of that alpha: it does not know that they are one "
                "model"},
               {{"black", "white", "checker", "alpha_to_0", "alpha_to_1", "one_layer", "64_layers", "unequal", "window",
                 "close_pair", "interleaved"},
                passes,
                "every fragment is kept and composited in 32 bits"},
               {{"opaque_front", "opaque_behind", "opaque_between"}, passes, "hidden fragments are never stored"},
               {{"glass", "leaves"}, passes, "it sorts the fragments of each pixel, not primitives"}}}},
    };
}

}  // namespace sheer::test
