#include "tests/render/method_row.h"

namespace sheer::test {

// At threshold 0 nothing is under the threshold, so nothing may be discarded; at 0.01, in the litmus scenes, that much
// of a color may be left out.
MethodRow row_f2bd() {
    return {
        .id = "f2bd",
        .formula = [](const nlohmann::json&) -> Formula { return over_by_depth; },
        .sorts_primitives = true,
        .variants = {{{{"threshold", 0}}, rounded_front_to_back},
                     {{{"threshold", 0}, {"alpha_target", "separate"}}, rounded_front_to_back},
                     {{{"threshold", 0}, {"feedback", "framebuffer_fetch"}, {"batch", 3}}, rounded_front_to_back},
                     {{{"threshold", 0}, {"form", "if_discard"}, {"sync", "flush"}, {"batch", 3}},
                      rounded_front_to_back},
                     {{{"threshold", 0}, {"sync", "finish"}, {"batch", 3}}, rounded_front_to_back},
                     {{{"threshold", 0}, {"inverted", false}}, rounded_with_opacity},
                     {{{"threshold", 0},
                       {"inverted", false},
                       {"alpha_target", "separate"},
                       {"alpha_factors", "dst_alpha_zero"}},
                      rounded_with_opacity},
                     {{{"threshold", 0}, {"inverted", false}, {"alpha_target", "separate"}}, rounded_with_opacity},
                     {{{"threshold", 0}, {"alpha_target", "separate"}, {"alpha_factors", "dst_alpha_zero"}},
                      rounded_front_to_back}},
        .litmus =
            {{"",
              {nlohmann::json::object(),
               {{"alpha_target", "separate"}},
               {{"feedback", "framebuffer_fetch"}, {"batch", 3}},
               {{"form", "if_discard"}},
               {{"inverted", false}, {"sync", "flush"}, {"batch", 2}}},
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
                "what it discards has less than the threshold, 0.01, of transmittance left, so no color is off "
                "by more"},
               {{"opaque_front", "opaque_behind", "opaque_between"}, passes, "it shares the opaque pass's depth"},
               {{"glass", "leaves"},
                fails,
                "a primitive is drawn whole, so one side of the cut has the wrong order"}}}},
        .early_exit = {{nlohmann::json::object(), {1, 1, 1, 1, 1}, "each fragment reads what is left at its pixel"}},
        .litmus_tolerance = 0.01,
    };
}

}  // namespace sheer::test
