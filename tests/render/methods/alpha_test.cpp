#include "tests/render/method_row.h"

namespace sheer::test {

MethodRow row_alpha_test() {
    return {
        .id = "alpha_test",
        .formula = formula_of("alpha_test"),
        .variants = {{nlohmann::json::object()}, {{{"order", "near_to_far"}}}},
        .litmus = {{"",
                    {nlohmann::json::object(), {{"order", "near_to_far"}}},
                    {{{"shuffled"}, passes, "the nearest fragment with enough alpha wins by the depth test"},
                     {{"overflow"}, passes, "alpha 0.96 is drawn as 1, and 32 layers of it let nothing through"},
                     {{"self_overlap"}, fails, "alpha from 0.5 up is drawn as 1, the rest as 0"},
                     {{"fade"}, fails, "the model is there from alpha 0.5 on, and not before"},
                     {{"unequal", "window", "close_pair", "interleaved"},
                      fails,
                      "alpha from 0.5 up is drawn as 1, the rest as 0"},
                     {{"black", "white", "checker", "opaque_behind", "opaque_between", "one_layer", "glass"},
                      fails,
                      "alpha from 0.5 up is drawn as 1, the rest as 0"},
                     {{"alpha_to_0", "64_layers"}, fails, "no fragment reaches the reference, so all layers vanish"},
                     {{"alpha_to_1"}, passes, "what it draws as opaque almost is: off by at most 1/128"},
                     {{"leaves"}, passes, "the depth test decides per pixel"},
                     {{"opaque_front"}, passes, "the depth test hides what is behind"}}}},
    };
}

}  // namespace sheer::test
