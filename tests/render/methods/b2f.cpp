#include "tests/render/method_row.h"

namespace sheer::test {

MethodRow row_b2f() {
    return {
        .id = "b2f",
        .formula = [](const nlohmann::json&) -> Formula { return over_by_depth; },
        .sorts_primitives = true,
        .variants = {{nlohmann::json::object(), rounded_back_to_front}},
        .litmus =
            {{"",
              {nlohmann::json::object()},
              {{{"shuffled"}, passes, "it sorts before it draws"},
               {{"overflow"}, passes, "it sums nothing that could overflow; of one color, the layers have no order"},
               {{"self_overlap"}, fails, "the hull is drawn whole, by its middle, which is behind the part within it"},
               {{"fade"},
                fails,
                "the inside of a model shows, as of any layers of that alpha: it does not know that they are one "
                "model"},
               {{"black", "white", "checker", "alpha_to_0", "alpha_to_1", "one_layer", "64_layers", "unequal", "window",
                 "close_pair", "interleaved"},
                passes,
                "the over operator from far to near is the definition of the correct picture"},
               {{"opaque_front", "opaque_behind", "opaque_between"},
                passes,
                "the depth test against the opaque pass hides what is behind"},
               {{"glass", "leaves"},
                fails,
                "a primitive is drawn whole, so one side of the cut has the wrong order"}}}},
    };
}

}  // namespace sheer::test
