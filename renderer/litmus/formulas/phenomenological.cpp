#include "renderer/litmus/formula.h"

#include <algorithm>
#include <cmath>

namespace sheer::litmus {

namespace {

struct TransmittedSums {
    double count = 0, weights = 0;
    Color reflected = {}, modulation = {1, 1, 1};
};

TransmittedSums transmitted_sums(const Stack& stack, double transmission) {
    TransmittedSums sums;
    for (const Fragment& fragment : stack.fragments) {
        if (fragment.alpha == 0) continue;
        ++sums.count;
        const double mean = transmission * (fragment.color[0] + fragment.color[1] + fragment.color[2]) / 3;
        const double net_coverage = fragment.alpha * (1 - mean);
        const double root = (8 * net_coverage + 0.01) * (1 - 0.95 * fragment.depth);
        const double weight = std::clamp(1e3 * std::pow(root, 3), 1e-2, 3e2);
        sums.weights += weight * net_coverage;
        for (std::size_t i = 0; i < 3; ++i) {
            sums.reflected[i] += weight * fragment.alpha * (1 - transmission) * fragment.color[i];
            sums.modulation[i] *= 1 - fragment.alpha * (1 - transmission * fragment.color[i]);
        }
    }
    return sums;
}

Formula reflected_over_transmitted(const nlohmann::json& parameters) {
    return [transmission = parameters.value("transmission", 0.0)](const Stack& stack) {
        const TransmittedSums sums = transmitted_sums(stack, transmission);
        if (sums.count == 0) return stack.below;
        Color color;
        for (std::size_t i = 0; i < 3; ++i) {
            const double average = sums.reflected[i] / std::max(sums.weights, 1e-5);
            color[i] = average * (1 - sums.modulation[i]) + stack.below[i] * sums.modulation[i];
        }
        return color;
    };
}

}  // namespace

FormulaInfo formula_phenomenological() {
    return {.id = "phenomenological",
            .name = "phenomenological transparency",
            .make = reflected_over_transmitted,
            .variants = {
                nlohmann::json::object(), {{"transmission", 0.25}}, {{"transmission", 0.5}}, {{"transmission", 1}}}};
}

}  // namespace sheer::litmus
