#include "tests/render/method_row.h"

#include <algorithm>
#include <cmath>

namespace sheer::test {

namespace {

/// The nearest k from near to far, as their transmittances of 8 bits let them through, over what becomes of the rest.
Color nearest_over_rest(const Stack& stack, std::size_t k, const std::string& rest) {
    Stack near_to_far = sorted(stack);
    std::erase_if(near_to_far.fragments, [](const Fragment& fragment) { return fragment.alpha == 0; });
    std::ranges::reverse(near_to_far.fragments);
    Color color = {}, rest_colors = {};
    double transmittance = 1, rest_transmittance = 1, rest_alphas = 0;
    for (std::size_t place = 0; place < near_to_far.fragments.size(); ++place) {
        const Fragment& fragment = near_to_far.fragments[place];
        Color& sum = place < k ? color : rest_colors;
        const double weight = place < k ? transmittance * fragment.alpha : fragment.alpha;
        for (std::size_t i = 0; i < 3; ++i) sum[i] += weight * fragment.color[i];
        if (place < k) {
            transmittance *= std::round(255 * (1 - fragment.alpha)) / 255;
        } else {
            rest_transmittance *= 1 - fragment.alpha;
            rest_alphas += fragment.alpha;
        }
    }
    for (std::size_t i = 0; i < 3; ++i) {
        double behind = stack.below[i];
        if (rest != "dropped") behind *= rest_transmittance;
        if (rest == "weighted_average" && rest_alphas > 0)
            behind += (1 - rest_transmittance) * rest_colors[i] / rest_alphas;
        color[i] += transmittance * behind;
    }
    return color;
}

/// Computed in 32-bit floats; the opaque picture and the result are rounded.
double rounded_twice(const Stack& stack, PixelFormat format) {
    return format == PixelFormat::rgba32f ? rounded_once(stack, format) : 1.01 * step_of(format);
}

std::vector<LitmusExpectation> nearest_expectations(const std::string& of_64_layers,
                                                    const LitmusExpectation& of_interleaved) {
    return {
        {{"shuffled"}, passes, "the least keys are the same in any order"},
        {{"black", "white", "checker", "alpha_to_0", "alpha_to_1", "one_layer"},
         passes,
         "up to eight layers are kept, and blended with transmittances rounded to 1/255: off by less than a level per "
         "layer"},
        {{"opaque_front", "opaque_behind", "opaque_between"},
         passes,
         "both passes are tested against the opaque depth"},
        {{"glass", "leaves"}, passes, "it sorts the fragments of each pixel, not primitives"},
        {{"64_layers"}, fails, of_64_layers},
        {{"unequal", "window", "close_pair"}, passes, "three layers are among the eight nearest"},
        of_interleaved};
}

}  // namespace

MethodRow row_nearest_k() {
    return {
        .id = "nearest_k",
        .formula = [](const nlohmann::json& parameters) -> Formula {
            return [=](const Stack& stack) {
                return nearest_over_rest(stack, parameters.value("k", std::size_t{8}),
                                         parameters.value("rest", "weighted_average"));
            };
        },
        .variants = {{nlohmann::json::object(), rounded_twice},
                     {{{"rest", "dropped"}}, rounded_twice},
                     {{{"rest", "transmittance"}, {"k", 3}}, rounded_twice},
                     {{{"k", 1}}, rounded_twice},
                     {{{"k", 32}}, rounded_twice}},
        .litmus = {{"nearest_k, rest averaged",
                    {nlohmann::json::object()},
                    nearest_expectations(
                        "the average of the layers behind the eight nearest mixes the blue of the next 24 "
                        "with the green of the farthest",
                        {{"interleaved"},
                         passes,
                         "the average of the eight layers behind has nearly their color, and 6 % of the weight"})},
                   {"nearest_k, rest dropped",
                    {{{"rest", "dropped"}}},
                    nearest_expectations(
                        "the background shines through the eight nearest as if the others were not "
                        "there",
                        {{"interleaved"},
                         fails,
                         "the background shows with 0.7 to the power of 8, 6 %, instead of the eight layers behind"})},
                   {"nearest_k, rest darkens",
                    {{{"rest", "transmittance"}}},
                    nearest_expectations(
                        "the blue and green behind the eight nearest are missing",
                        {{"interleaved"}, fails, "6 % of the color, that of the eight layers behind, is missing"})}},
    };
}

}  // namespace sheer::test
