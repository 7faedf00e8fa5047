#include "renderer/litmus/formulas/weighted_average.h"

#include <cmath>

namespace sheer::litmus {

namespace {

Color average_layers(const Stack& stack) {
    const AverageSums sums = average_sums(stack);
    if (sums.count == 0) return stack.below;
    Color color;
    for (std::size_t i = 0; i < 3; ++i) color[i] = sums.colors[i] / sums.alphas;
    return mix(color, stack.below, std::pow(1 - sums.alphas / sums.count, sums.count));
}

}  // namespace

AverageSums average_sums(const Stack& stack) {
    AverageSums sums;
    for (const Fragment& fragment : stack.fragments) {
        if (fragment.alpha == 0) continue;
        ++sums.count;
        sums.alphas += fragment.alpha;
        for (std::size_t i = 0; i < 3; ++i) sums.colors[i] += fragment.alpha * fragment.color[i];
    }
    return sums;
}

FormulaInfo formula_weighted_average() {
    return {.id = "weighted_average", .name = "the weighted average", .make = [](const nlohmann::json&) -> Formula {
                return average_layers;
            }};
}

}  // namespace sheer::litmus
