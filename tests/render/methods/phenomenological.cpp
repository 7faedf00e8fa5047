#include "tests/render/method_row.h"

#include <algorithm>
#include <cmath>

namespace sheer::test {

namespace {

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
        .formula = formula_of("phenomenological"),
        .weighs_depths = true,
        .variants = {{nlohmann::json::object(), transmitted_bound, false, 64},
                     {{{"transmission", 0.5}}, transmitted_bound, false, 64},
                     {{{"transmission", 1}}, transmitted_bound, false, 64}},
        .litmus = {{"",
                    {nlohmann::json::object()},
                    {{{"shuffled"}, passes, "sums and products do not depend on the order, except for rounding"},
                     {{"overflow"}, passes, "its weights are cut at 300, so 32 layers sum to 9,600 at most"},
                     {{"self_overlap"},
                      fails,
                      "the weights are at their limit of 300 for both, so the part within shows as much as if it were "
                      "in front"},
                     {{"fade"},
                      fails,
                      "the inside of a model shows, as of any layers of that alpha: it does not know that they are one "
                      "model"},
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
                     {{"overflow"}, fails, "a quarter of the color tints what is behind, which these layers hide"},
                     {{"self_overlap"}, fails, "a quarter of each color is missing, and the rest is a mean"},
                     {{"fade"}, fails, "a quarter of each color is missing, and the inside shows"},
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
