#include "tests/render/method_row.h"

namespace sheer::test {

// At threshold 0 nothing is marked; at 0.01, in the litmus scenes, that much of a color may be left out.
MethodRow row_depth_marks() {
    return {
        .id = "depth_marks",
        .formula = [](const nlohmann::json&) -> Formula { return over_by_depth; },
        .sorts_primitives = true,
        .variants = {{{{"threshold", 0}, {"interval", 3}}, rounded_front_to_back}},
        .litmus =
            {{"",
              {nlohmann::json::object(), {{"interval", 2}}},
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
                "a mark is set if less than the threshold, 0.01, of transmittance is left, so no color is off by "
                "more"},
               {{"opaque_front", "opaque_behind", "opaque_between"}, passes, "it starts from the opaque pass's depth"},
               {{"glass", "leaves"},
                fails,
                "a primitive is drawn whole, so one side of the cut has the wrong order"}}}},
        .early_exit = {{nlohmann::json::object(),
                        {1, 16, 4, 1, 1},
                        "a pixel is marked after every 16 primitives, which are 16 layers, or four that are made of "
                        "four rectangles each"}},
        .litmus_tolerance = 0.01,
    };
}

}  // namespace sheer::test
