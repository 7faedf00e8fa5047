#include "renderer/litmus/formulas/wboit.h"

#include "tests/render/method_row.h"

#include <algorithm>
#include <cmath>

namespace sheer::test {

namespace {

/// In 16-bit floats each of n additions rounds both sums by 2^-10 of them at most, and what is added to the least sum
/// by 2^-24; each of n factors 1 - alpha is off by 2^-11 and rounded.
Bound weighted_bound(const nlohmann::json& parameters) {
    return [=](const Stack& stack, PixelFormat format) {
        if (format == PixelFormat::rgba32f) return rounded_once(stack, format);
        const WeightedSums sums = weighted_sums(stack, parameters);
        const double sums_off = (sums.count + 1) * (2 * 0x1p-10 + (sums.count == 0 ? 0 : 0x1p-24 / sums.weights));
        return std::min(1.0, sums_off) + (sums.count + 1) * 0x1p-10 + step_of(format);
    };
}

MethodVariant weighted_variant(const nlohmann::json& parameters, std::size_t most_layers) {
    return {parameters, weighted_bound(parameters), false, most_layers};
}

}  // namespace

// 16 layers of the greatest weight do not overflow the sums in 16-bit floats, nor do 1,024 of a weight up to 60.
MethodRow row_wboit() {
    return {
        .id = "wboit",
        .formula = formula_of("wboit"),
        .weighs_depths = true,
        .variants = {weighted_variant(nlohmann::json::object(), 16), weighted_variant({{"weight", "equal"}}, 1024),
                     weighted_variant({{"weight", "eq7"}}, 16),
                     weighted_variant({{"weight", "eq8"}, {"depth_scale", 30}, {"alpha_scale", 10}}, 16),
                     weighted_variant({{"weight", "eq9"}, {"depth_scale", 200}}, 1024),
                     weighted_variant({{"greatest_weight", 60}}, 1024)},
        .litmus =
            {{"",
              {nlohmann::json::object()},
              {{{"shuffled"}, passes, "sums and products do not depend on the order, except for rounding"},
               {{"overflow"},
                fails,
                "the weights sum to 76,000, over what 16 bits hold: the mean is divided by 65,504 on llvmpipe, which "
                "is "
                "too bright, and by infinity on other devices, which gives black"},
               {{"self_overlap"},
                fails,
                "the weights follow the square of the alpha and the cube of the depth, so the part of 0.8 outweighs "
                "the hull of 0.4 in front of it"},
               {{"fade"},
                fails,
                "the inside of a model shows, as of any layers of that alpha: it does not know that they are one "
                "model"},
               {{"unequal", "close_pair", "interleaved"},
                fails,
                "the weights follow the depth, not what is in front: two layers at nearly one depth have nearly the "
                "same weight"},
               {{"window"},
                fails,
                "the leaf that is hidden keeps the weight of its depth, 0.008 of 0.125, and shows through the one in "
                "front of it"},
               {{"black", "white", "checker", "opaque_behind", "glass"},
                fails,
                "the weights follow the cube of the distance to the far plane, not the alphas of what is in front; the "
                "nearest layer gets too much where the farther one is far, and too little where it is near"},
               {{"alpha_to_0"}, passes, "for faint layers even a wrong weight is off by little: all are nearly white"},
               {{"alpha_to_1", "leaves"},
                fails,
                "it shows a mean of the layers, of which the nearest hides the others; weighted with (0.9, 0.8, 0.7, "
                "0.6) cubed, the nearest has 0.4 of it"},
               {{"opaque_front"}, passes, "the depth test hides what is behind"},
               {{"opaque_between", "one_layer"}, passes, "one layer is its own mean, whatever its weight"},
               {{"64_layers"},
                fails,
                "the weights fall more slowly than the transmittance at first: the red of the nearest eight is too "
                "weak"}}},
             {"wboit, equal weights",
              {{{"weight", "equal"}}},
              {{{"shuffled"}, passes, "sums and products do not depend on the order, except for rounding"},
               {{"overflow"}, passes, "without weights the alphas sum to 31"},
               {{"self_overlap"}, fails, "the mean color does not know what is in front"},
               {{"fade"},
                fails,
                "the inside of a model shows, as of any layers of that alpha: it does not know that they are one "
                "model"},
               {{"unequal", "window", "close_pair", "interleaved"},
                fails,
                "the mean color does not know what is in front, so of two leaves both show"},
               {{"black", "white", "checker", "opaque_behind", "glass"},
                fails,
                "near and far colors have the same weight: for two layers of 0.5 an eighth of their difference"},
               {{"alpha_to_0"}, passes, "for faint layers order hardly matters"},
               {{"alpha_to_1", "leaves"},
                fails,
                "it shows the mean of the layers, of which the nearest hides the others"},
               {{"opaque_front"}, passes, "the depth test hides what is behind"},
               {{"opaque_between", "one_layer"}, passes, "one layer is its own mean"},
               {{"64_layers"}, fails, "the mean of all colors is mostly blue and green"}}}},
    };
}

}  // namespace sheer::test
