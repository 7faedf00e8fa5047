#include "tests/render/method_row.h"

namespace sheer::test {

// At threshold 0 nothing is closed; at 0.01, in the litmus scenes, that much of a color may be left out.
MethodRow row_f2bh() {
    return {
        .id = "f2bh",
        .formula = [](const nlohmann::json&) -> Formula { return over_by_depth; },
        .sorts_primitives = true,
        .variants = {{{{"threshold", 0}, {"first_layers", 3}, {"growth", 1}}, rounded_front_to_back},
                     {{{"threshold", 0}, {"first_layers", 3}, {"within_batch", "nothing"}}, rounded_front_to_back}},
        .litmus =
            {{"",
              {nlohmann::json::object(),
               {{"first_layers", 1}, {"growth", 1}, {"tile_px", 4}},
               {{"first_layers", 1}, {"growth", 1}, {"tile_px", 4}, {"within_batch", "nothing"}}},
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
                "a pixel is closed if less than the threshold, 0.01, of transmittance is left, so no color is off by "
                "more"},
               {{"opaque_front", "opaque_behind", "opaque_between"}, passes, "it starts from the opaque pass's depth"},
               {{"glass", "leaves"},
                fails,
                "a primitive is drawn whole, so one side of the cut has the wrong order"}}}},
        .early_exit = {{nlohmann::json::object(),
                        {1, 1, 1, 1, 1},
                        "within a batch each fragment reads what is left at its pixel"},
                       {{{"within_batch", "nothing"}, {"first_layers", 8}, {"growth", 1}},
                        {1, 8, 8.1, 1, 1.08},
                        "up to eight layers are drawn over a pixel before it is closed"}},
        .litmus_tolerance = 0.01,
    };
}

}  // namespace sheer::test
