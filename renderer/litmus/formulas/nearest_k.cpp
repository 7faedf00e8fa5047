#include "renderer/litmus/formula.h"

#include <algorithm>
#include <cmath>

namespace sheer::litmus {

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

}  // namespace

FormulaInfo formula_nearest_k() {
    std::vector<nlohmann::json> variants;
    for (const char* rest : {"weighted_average", "transmittance", "dropped"})
        for (const int k : {1, 2, 4, 8}) variants.push_back({{"k", k}, {"rest", rest}});
    return {.id = "nearest_k",
            .name = "the nearest k fragments",
            .make = [](const nlohmann::json& parameters) -> Formula {
                return [=](const Stack& stack) {
                    return nearest_over_rest(stack, parameters.value("k", std::size_t{8}),
                                             parameters.value("rest", "weighted_average"));
                };
            },
            .variants = variants};
}

}  // namespace sheer::litmus
