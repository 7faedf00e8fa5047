#include "renderer/litmus/formula.h"

namespace sheer::litmus {

namespace {

/// Slides 20 and 34; if there is nothing to sum, what is behind.
Color sums(const Stack& stack, bool full) {
    double alphas = 0, reciprocals = 0, product = 1;
    Color colors = {};
    for (const Fragment& fragment : stack.fragments) {
        if (fragment.alpha == 0) continue;
        alphas += fragment.alpha;
        reciprocals += 1 / fragment.alpha;
        product *= fragment.alpha;
        for (std::size_t i = 0; i < 3; ++i) colors[i] += fragment.alpha * fragment.color[i];
    }
    if (alphas == 0) return stack.below;
    Color color;
    for (std::size_t i = 0; i < 3; ++i) {
        const double d = stack.below[i];
        color[i] = d + colors[i] - d * alphas;
        if (full) color[i] += d * product - d * reciprocals * product;
    }
    return color;
}

}  // namespace

FormulaInfo formula_meshkin() {
    return {.id = "meshkin",
            .name = "Meshkin's sums",
            .make = [](const nlohmann::json& parameters) -> Formula {
                const bool full = parameters.value("variant", "simple") == "full";
                return [full](const Stack& stack) { return sums(stack, full); };
            },
            .variants = {{{"variant", "simple"}}, {{"variant", "full"}}}};
}

}  // namespace sheer::litmus
