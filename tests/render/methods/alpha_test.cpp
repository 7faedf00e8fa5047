#include "tests/render/method_row.h"

namespace sheer::test {

MethodRow row_alpha_test() {
    return {
        .id = "alpha_test",
        .formula = [](const nlohmann::json&) -> Formula {
            return [](const Stack& stack) { return nearest_of(stack, 0.5, stack.below); };
        },
        .variants = {{nlohmann::json::object()}, {{{"order", "near_to_far"}}}},
        .litmus = {{"",
                    {nlohmann::json::object(), {{"order", "near_to_far"}}},
                    {{{"shuffled"}, passes, "the nearest fragment with enough alpha wins by the depth test"},
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
