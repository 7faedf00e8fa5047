#include "tests/render/method_row.h"

namespace sheer::test {

MethodRow row_f2b() {
    return {
        .id = "f2b",
        .formula = [](const nlohmann::json&) -> Formula { return over_by_depth; },
        .sorts_primitives = true,
        .variants = {{nlohmann::json::object(), rounded_front_to_back},
                     {{{"alpha_factors", "dst_alpha_zero"}}, rounded_front_to_back},
                     {{{"inverted", false}}, rounded_with_opacity},
                     {{{"inverted", false}, {"alpha_factors", "dst_alpha_zero"}}, rounded_with_opacity}},
        .litmus =
            {{"",
              {nlohmann::json::object(), {{"alpha_factors", "dst_alpha_zero"}}, {{"inverted", false}}},
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
                "it is the same sum as from far to near, added from the near end with the transmittance kept in alpha"},
               {{"opaque_front", "opaque_behind", "opaque_between"}, passes, "it shares the opaque pass's depth"},
               {{"glass", "leaves"},
                fails,
                "a primitive is drawn whole, so one side of the cut has the wrong order"}}}},
    };
}

}  // namespace sheer::test
