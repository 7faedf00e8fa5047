#include "tests/render/method_row.h"

#include <algorithm>

namespace sheer::test {

namespace {

/// Front to back up to the cap, without fragments under min_alpha. Full pixels have the previous frame behind: in a
/// uniform picture P(n) = A + T P(n - 1), with P(1) = A + T D.
Color capped(Stack stack, std::size_t cap, double min_alpha, int frames) {
    std::erase_if(stack.fragments, [&](const Fragment& fragment) { return fragment.alpha < min_alpha; });
    stack = sorted(stack);
    if (stack.fragments.size() <= cap) return over(stack);
    stack.fragments.erase(stack.fragments.begin(), stack.fragments.end() - static_cast<std::ptrdiff_t>(cap));
    for (int frame = 1; frame < frames; ++frame) stack.below = over(stack);
    return over(stack);
}

}  // namespace

// In the scenes of random layers no pixel reaches the cap, so nothing is cut off or guessed.
MethodRow row_stencil_cap() {
    return {
        .id = "stencil_cap",
        .formula = [](const nlohmann::json& parameters) -> Formula {
            return [=](const Stack& stack) {
                return capped(stack, parameters.value("layers", std::size_t{8}), parameters.value("min_alpha", 0.02),
                              parameters.value("frames", 30));
            };
        },
        .sorts_primitives = true,
        .variants =
            {{{{"layers", 64}, {"min_alpha", 0}, {"frames", 2}}, rounded_front_to_back, false, 64},
             {{{"layers", 64}, {"min_alpha", 0}, {"frames", 2}, {"zcull", true}}, rounded_front_to_back, false, 64}},
        .litmus =
            {{"",
              {nlohmann::json::object(), {{"zcull", true}}},
              {{{"shuffled"}, passes, "it sorts before it draws"},
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
