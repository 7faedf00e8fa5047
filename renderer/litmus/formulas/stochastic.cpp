#include <algorithm>
#include <vector>

#include "renderer/core/random.h"
#include "renderer/litmus/formula.h"

namespace sheer::litmus {

namespace {

struct SampleMasks {
    int samples, passes;
    bool stratified;
};

/// A pass of stratified masks: a fragment covers its alpha times as many samples, rounded up or down at random, and
/// which ones is random.
Color stratified_pass(const Stack& near_to_far, int samples, Random& random) {
    std::vector<bool> is_covered(static_cast<std::size_t>(samples));
    std::vector<std::size_t> places(is_covered.size());
    Color sum = {};
    for (const Fragment& fragment : near_to_far.fragments) {
        const auto count = static_cast<std::size_t>(fragment.alpha * samples + random.unit());
        for (std::size_t i = 0; i < places.size(); ++i) places[i] = i;
        for (std::size_t i = 0; i < std::min(count, places.size()); ++i) {
            std::swap(places[i], places[i + random.below(places.size() - i)]);
            if (is_covered[places[i]]) continue;
            is_covered[places[i]] = true;
            for (std::size_t k = 0; k < 3; ++k) sum[k] += fragment.color[k] / samples;
        }
    }
    const auto left = static_cast<double>(std::ranges::count(is_covered, false)) / samples;
    for (std::size_t k = 0; k < 3; ++k) sum[k] += left * near_to_far.below[k];
    return sum;
}

/// The variance of a pass, from simulated ones: it has no closed form for more layers than one.
Color stratified_variance(const Stack& stack, int samples) {
    constexpr int draws = 200;
    Random random(1);
    Stack near_to_far = sorted(stack);
    std::ranges::reverse(near_to_far.fragments);
    const Color mean = over_by_depth(stack);
    Color variance = {};
    for (int i = 0; i < draws; ++i) {
        const Color drawn = stratified_pass(near_to_far, samples, random);
        for (std::size_t k = 0; k < 3; ++k) variance[k] += (drawn[k] - mean[k]) * (drawn[k] - mean[k]) / draws;
    }
    return variance;
}

Formula variance_of_mean(const nlohmann::json& parameters) {
    const SampleMasks of = {parameters.value("samples", 4), parameters.value("passes", 1),
                            parameters.value("masks", "stratified") == "stratified"};
    return [of](const Stack& stack) {
        Color variance = of.stratified ? stratified_variance(stack, of.samples) : variance_of_sample(stack);
        for (double& channel : variance) channel /= of.stratified ? of.passes : of.samples * of.passes;
        return variance;
    };
}

}  // namespace

FormulaInfo formula_stochastic() {
    std::vector<nlohmann::json> variants;
    for (const char* masks : {"stratified", "independent"})
        for (const int passes : {1, 4, 16}) variants.push_back({{"masks", masks}, {"passes", passes}});
    return {.id = "stochastic",
            .name = "stochastic transparency",
            .make = [](const nlohmann::json&) -> Formula { return over_by_depth; },
            .variance = variance_of_mean,
            .weighs_by_alpha = false,
            .variants = variants};
}

}  // namespace sheer::litmus
