#include "renderer/litmus/formula.h"

#include <algorithm>

namespace sheer::litmus {

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

FormulaInfo formula_stencil_cap() {
    return {.id = "stencil_cap",
            .name = "front to back up to a number of layers",
            .make = [](const nlohmann::json& parameters) -> Formula {
                return [=](const Stack& stack) {
                    return capped(stack, parameters.value("layers", std::size_t{8}),
                                  parameters.value("min_alpha", 0.02), parameters.value("frames", 30));
                };
            },
            .sorts_primitives = true,
            .variants = {{{"layers", 4}}, {{"layers", 8}}, {{"layers", 16}}}};
}

}  // namespace sheer::litmus
