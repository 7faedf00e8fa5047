#include "tests/render/method_row.h"

#include <algorithm>
#include <cmath>

namespace sheer::test {

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

/// As that of WBOIT: n roundings of both sums by 2^-10, and of the product by as much. The reflected colors may be
/// brighter than 1 by the net coverage.
double transmitted_bound(const Stack& stack, PixelFormat format) {
    if (format == PixelFormat::rgba32f) return rounded_once(stack, format);
    const auto layers = static_cast<double>(stack.fragments.size());
    return std::min(1.0, 4 * (layers + 1) * 0x1p-10) + (layers + 1) * 0x1p-10 + step_of(format);
}

}  // namespace

// More layers than 64 could overflow the 16-bit sums: weights reach 300.
MethodRow row_phenomenological() {
    return {
        .id = "phenomenological",
        .formula = reflected_over_transmitted,
        .weighs_depths = true,
        .variants = {{nlohmann::json::object(), transmitted_bound, false, 64},
                     {{{"transmission", 0.5}}, transmitted_bound, false, 64},
                     {{{"transmission", 1}}, transmitted_bound, false, 64}},
        .litmus = {{"",
                    {nlohmann::json::object()},
                    {{{"shuffled"}, passes, "sums and products do not depend on the order, except for rounding"},
                     {{"unequal", "window", "close_pair", "interleaved"},
                      fails,
                      "the weights do not know what is in front, so of two leaves both show; they are at their limit "
                      "of 300 for nearly all of these layers"},
                     {{"black", "white", "checker", "opaque_behind", "glass", "alpha_to_1", "leaves"},
                      fails,
                      "at alphas from 0.5 up the weights reach their limit of 300 near and far: the mean of all layers "
                      "shows, "
                      "over the right part of the background"},
                     {{"alpha_to_0"}, passes, "for faint layers the weights hardly matter"},
                     {{"opaque_front"}, passes, "the depth test hides what is behind"},
                     {{"opaque_between", "one_layer"}, passes, "one layer is its own mean, whatever its weight"},
                     {{"64_layers"},
                      fails,
                      "the weights fall with the cube of the depth, more slowly at first than what the near layers let "
                      "through"}}},
                   {"phenomenological, transmitting a quarter",
                    {{{"transmission", 0.25}}},
                    {{{"shuffled"}, passes, "sums and products do not depend on the order, except for rounding"},
                     {{"unequal", "window", "close_pair", "interleaved"},
                      fails,
                      "what a quarter of each color tints instead of being reflected is missing"},
                     {{"black", "white", "checker", "opaque_behind", "glass", "alpha_to_1", "leaves", "opaque_between",
                       "one_layer", "64_layers"},
                      fails,
                      "a quarter of each color is not reflected but tints what is behind, which alpha blending does "
                      "not know; a "
                      "single layer is different already"},
                     {{"alpha_to_0"},
                      passes,
                      "six layers of 1/128 reflect at most 4.7 % of white; a quarter less is under three levels"},
                     {{"opaque_front"}, passes, "the depth test hides what is behind"}}}},
    };
}

}  // namespace sheer::test
