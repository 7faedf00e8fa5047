#include "tests/render/method_row.h"

#include <algorithm>

namespace sheer::test {

// In the scenes of random layers no pixel reaches the cap, so nothing is cut off or guessed.
MethodRow row_stencil_cap() {
    return {
        .id = "stencil_cap",
        .formula = formula_of("stencil_cap"),
        .sorts_primitives = true,
        .variants =
            {{{{"layers", 64}, {"min_alpha", 0}, {"frames", 2}}, rounded_front_to_back, false, 64},
             {{{"layers", 64}, {"min_alpha", 0}, {"frames", 2}, {"zcull", true}}, rounded_front_to_back, false, 64}},
        .litmus =
            {{"",
              {nlohmann::json::object(), {{"zcull", true}}},
              {{{"shuffled"}, passes, "it sorts before it draws"},
               {{"overflow"}, passes, "the nearest eight let nothing through"},
               {{"self_overlap"}, fails, "the hull is drawn whole, by its middle, which is behind the part within it"},
               {{"fade"},
                fails,
                "the inside of a model shows, as of any layers of that alpha: it does not know that they are one "
                "model"},
               {{"unequal", "window", "close_pair"}, passes, "with fewer layers than the cap of 8 it is F2B"},
               {{"interleaved"},
                passes,
                "the nearest eight let 0.7 to the power of 8 through, 6 %, which over the frames is filled with what "
                "they look like by themselves, much like the rest"},
               {{"black", "white", "checker", "alpha_to_1", "one_layer"},
                passes,
                "with fewer layers than the cap of 8 it is F2B"},
               {{"alpha_to_0"},
                fails,
                "its alpha test drops what is under min_alpha, 0.02, so six faint layers vanish"},
               {{"opaque_front", "opaque_behind", "opaque_between"}, passes, "it starts from the opaque pass's depth"},
               {{"glass", "leaves"}, fails, "a primitive is drawn whole, so one side of the cut has the wrong order"},
               {{"64_layers"},
                fails,
                "layers 9 to 64 are lost; over the frames the picture tends to what the nearest eight look like by "
                "themselves"}}}},
    };
}

}  // namespace sheer::test
