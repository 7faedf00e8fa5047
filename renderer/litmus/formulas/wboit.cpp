#include "renderer/litmus/formulas/wboit.h"

#include <algorithm>
#include <cmath>

namespace sheer::litmus {

namespace {

/// A sum over it is stored as this by llvmpipe. Other devices store infinity, and the color is black.
constexpr double largest_in_16_bits = 65504;

/// Equations 7 to 10. In `layers` scenes the distance from the camera is the depth.
double paper_weight(const std::string& equation, double depth, double alpha, const nlohmann::json& parameters) {
    if (equation == "equal") return 1;
    const double z = depth * parameters.value("depth_scale", 1.0);
    double of_depth = 0;
    if (equation == "eq7") of_depth = 10 / (1e-5 + std::pow(z / 5, 2) + std::pow(z / 200, 6));
    if (equation == "eq8") of_depth = 10 / (1e-5 + std::pow(z / 10, 3) + std::pow(z / 200, 6));
    if (equation == "eq9") of_depth = 0.03 / (1e-5 + std::pow(z / 200, 4));
    if (equation == "eq10") of_depth = 3e3 * std::pow(1 - depth, 3);
    return std::min(1.0, alpha * parameters.value("alpha_scale", 1.0)) *
           std::max(1e-2, std::min(parameters.value("greatest_weight", 3e3), of_depth));
}

Formula weighted_blend(const nlohmann::json& parameters) {
    return [=](const Stack& stack) {
        const WeightedSums sums = weighted_sums(stack, parameters);
        if (sums.count == 0) return stack.below;
        const double greatest = stack.sums_in_16_bits ? largest_in_16_bits : INFINITY;
        Color color;
        for (std::size_t i = 0; i < 3; ++i)
            color[i] = std::min(sums.colors[i], greatest) / std::min(sums.weights, greatest);
        return mix(color, stack.below, sums.revealage);
    };
}

}  // namespace

WeightedSums weighted_sums(const Stack& stack, const nlohmann::json& parameters) {
    WeightedSums sums;
    for (const Fragment& fragment : stack.fragments) {
        if (fragment.alpha == 0) continue;
        const double weight = fragment.alpha * paper_weight(parameters.value("weight", "eq10"), fragment.depth,
                                                            fragment.alpha, parameters);
        ++sums.count;
        sums.weights += weight;
        sums.revealage *= 1 - fragment.alpha;
        for (std::size_t i = 0; i < 3; ++i) sums.colors[i] += weight * fragment.color[i];
    }
    return sums;
}

FormulaInfo formula_wboit() {
    return {.id = "wboit",
            .name = "WBOIT",
            .make = weighted_blend,
            .variants = {{{"weight", "eq7"}},
                         {{"weight", "eq8"}},
                         {{"weight", "eq9"}},
                         {{"weight", "eq10"}},
                         {{"weight", "equal"}}}};
}

}  // namespace sheer::litmus
