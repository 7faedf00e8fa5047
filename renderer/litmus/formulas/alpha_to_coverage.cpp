#include "renderer/litmus/formula.h"

namespace sheer::litmus {

namespace {

/// Without what has less alpha than the reference. Of n samples a fragment covers those i with alpha > i / n, which is
/// llvmpipe's rule; each shows its nearest fragment.
Color covered(const Stack& stack, int samples, double reference) {
    Color mean = {};
    for (int sample = 0; sample < samples; ++sample) {
        Stack covering{stack.below, {}};
        for (const Fragment& fragment : stack.fragments)
            if (fragment.alpha * samples > sample && fragment.alpha >= reference)
                covering.fragments.push_back(fragment);
        const Color seen = nearest_of(covering, 0, stack.below);
        for (std::size_t i = 0; i < 3; ++i) mean[i] += seen[i] / samples;
    }
    return mean;
}

}  // namespace

FormulaInfo formula_alpha_to_coverage() {
    return {.id = "alpha_to_coverage",
            .name = "alpha to coverage",
            .make = [](const nlohmann::json& parameters) -> Formula {
                return [samples = parameters.value("samples", 4), reference = parameters.value("reference", 0.0)](
                           const Stack& stack) { return covered(stack, samples, reference); };
            },
            .weighs_by_alpha = false,
            .variants = {{{"samples", 2}}, {{"samples", 4}}, {{"samples", 8}}}};
}

}  // namespace sheer::litmus
