#include "tests/render/method_row.h"

namespace sheer::test {

MethodRow row_opaque_depth() {
    return {
        .id = "opaque_depth",
        .formula = [](const nlohmann::json&) -> Formula { return over_by_depth; },
        .sorts_primitives = true,
        .variants = {{{{"batch", 3}}, rounded_front_to_back},
                     {{{"variant", "target_alpha"}, {"batch", 3}}, rounded_front_to_back},
                     {{{"variant", "two_pass"}}, rounded_front_to_back},
                     {{{"marks", "static"}}, rounded_front_to_back},
                     {{{"marks", "static"}, {"batch", 3}, {"depth_bits", 32}}, rounded_front_to_back},
                     {{{"variant", "target_alpha"}, {"marks", "static"}, {"batch", 3}, {"mark_pass", "shader"}},
                      rounded_front_to_back},
                     {{{"variant", "target_alpha"}, {"batch", 3}, {"mark_pass", "shader"}, {"depth_bits", 32}},
                      rounded_front_to_back}},
        .litmus =
            {{"",
              {nlohmann::json::object(),
               {{"variant", "target_alpha"}, {"batch", 3}},
               {{"variant", "two_pass"}},
               {{"marks", "static"}},
               {{"variant", "target_alpha"}, {"batch", 3}, {"mark_pass", "shader"}, {"depth_bits", 32}}},
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
                "what it leaves out is behind a fragment of alpha 1, where nothing is visible"},
               {{"opaque_front", "opaque_behind", "opaque_between"},
                passes,
                "the opaque pass's depth still hides what is behind it"},
               {{"glass", "leaves"},
                fails,
                "a primitive is drawn whole, so one side of the cut has the wrong order, and there its opaque "
                "fragments exclude nearer ones"}}}},
    };
}

}  // namespace sheer::test
