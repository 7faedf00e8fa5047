#include "tests/render/method_row.h"

#include <algorithm>
#include <cmath>

namespace sheer::test {

namespace {

double samples_of(const nlohmann::json& parameters) {
    return parameters.value("samples", 4) * parameters.value("passes", 1);
}

/// Independent samples, each of one surface; the passes of stratified masks are, and their samples vary less.
Bound samples_noise(const nlohmann::json& parameters) {
    return [=](const Stack& stack, PixelFormat format) {
        return mean_bound(sample_variance(stack), samples_of(parameters)) + step_of(format);
    };
}

/// With alpha correction the result is a quotient: the color sum C and the share of covered samples a are off by up to
/// e, so C / a is by (e + C / a e) / (a - e), times the opacity.
Bound corrected_noise(const nlohmann::json& parameters) {
    return [=](const Stack& stack, PixelFormat format) {
        double transmittance = 1;
        for (const Fragment& fragment : stack.fragments) transmittance *= 1 - fragment.alpha;
        const double opacity = 1 - transmittance;
        const double off = mean_bound(0.25, samples_of(parameters));
        return (opacity > off ? std::min(1.0, 2 * off / (opacity - off)) * opacity : opacity) + step_of(format);
    };
}

/// By depth, a sample adds y = alpha (color - D) for each fragment that nothing nearer covers there, up to the sum of
/// all. With T_j in front of fragment j, the mean square is the sum of T_j y_j (y_j + 2 times the sum of y_i in front
/// of it).
Bound depth_noise(const nlohmann::json& parameters) {
    return [=](const Stack& stack, PixelFormat format) {
        Stack near_to_far = sorted(stack);
        std::ranges::reverse(near_to_far.fragments);
        double greatest = 0, most = 1;
        for (std::size_t i = 0; i < 3; ++i) {
            double transmittance = 1, in_front = 0, mean = 0, square = 0, alphas = 0;
            for (const Fragment& fragment : near_to_far.fragments) {
                const double y = fragment.alpha * (fragment.color[i] - stack.below[i]);
                mean += transmittance * y;
                square += transmittance * y * (y + 2 * in_front);
                in_front += y;
                alphas += fragment.alpha;
                transmittance *= 1 - fragment.alpha;
            }
            greatest = std::max(greatest, square - mean * mean);
            most = std::max(most, alphas);
        }
        return most * mean_bound(greatest / (most * most), samples_of(parameters)) + step_of(format);
    };
}

Bound stochastic_noise(const nlohmann::json& parameters) {
    if (parameters.value("variant", "color") == "depth") return depth_noise(parameters);
    return parameters.value("alpha_correction", false) ? corrected_noise(parameters) : samples_noise(parameters);
}

MethodVariant stochastic_variant(const nlohmann::json& parameters) {
    return {parameters, stochastic_noise(parameters), false, 64};
}

}  // namespace

MethodRow row_stochastic() {
    return {
        .id = "stochastic",
        .formula = [](const nlohmann::json&) -> Formula { return over_by_depth; },
        .noise = stochastic_noise,
        .variants = {stochastic_variant({{"passes", 64}, {"masks", "independent"}}),
                     stochastic_variant({{"passes", 64}}),
                     stochastic_variant({{"passes", 64}, {"alpha_correction", true}}),
                     stochastic_variant({{"passes", 64}, {"masks", "independent"}, {"variant", "depth"}})},
        .litmus =
            {{"",
              {{{"passes", 1024}},
               {{"passes", 1024}, {"masks", "independent"}},
               {{"passes", 1024}, {"masks", "independent"}, {"variant", "depth"}}},
              {{{"shuffled"}, passes, "in each sample the nearest fragment that covers it wins by the depth test"},
               {{"overflow"}, passes, "it sums nothing that could overflow; of one color, the layers have no order"},
               {{"self_overlap"}, passes, "the depth test decides per sample"},
               {{"fade"},
                fails,
                "the inside of a model shows, as of any layers of that alpha: it does not know that they are one "
                "model"},
               {{"black", "white", "checker", "alpha_to_0", "one_layer", "64_layers", "unequal", "window", "close_pair",
                 "interleaved", "opaque_between", "opaque_behind"},
                passes,
                "a layer is seen in as many samples as no nearer one covers, times its alpha: the over operator in "
                "the mean"},
               {{"alpha_to_1"}, passes, "alpha 1 covers every sample, and less almost every one"},
               {{"opaque_front"}, passes, "the depth test hides what is behind"},
               {{"glass", "leaves"}, passes, "the depth test decides per sample"}}}},
    };
}

}  // namespace sheer::test
