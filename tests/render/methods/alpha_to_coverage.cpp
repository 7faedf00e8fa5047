#include "tests/render/method_row.h"

namespace sheer::test {

namespace {

/// Of n samples a fragment covers those i with alpha > i / n, which is llvmpipe's rule; each shows its nearest
/// fragment.
Color covered(const Stack& stack, int samples) {
    Color mean = {};
    for (int sample = 0; sample < samples; ++sample) {
        Stack covering{stack.below, {}};
        for (const Fragment& fragment : stack.fragments)
            if (fragment.alpha * samples > sample) covering.fragments.push_back(fragment);
        const Color seen = nearest_of(covering, 0, stack.below);
        for (std::size_t i = 0; i < 3; ++i) mean[i] += seen[i] / samples;
    }
    return mean;
}

/// Each sample is rounded, and so is their mean.
double samples_bound(const Stack&, PixelFormat format) {
    return format == PixelFormat::rgba32f ? 1e-5 : step_of(format);
}

}  // namespace

MethodRow row_alpha_to_coverage() {
    return {
        .id = "alpha_to_coverage",
        .formula = [](const nlohmann::json&) -> Formula {
            return [](const Stack& stack) { return covered(stack, 4); };
        },
        .variants = {{nlohmann::json::object(), samples_bound, true}},
        .litmus = {{"",
                    {nlohmann::json::object()},
                    {{{"shuffled"}, passes, "in each sample the nearest fragment wins by the depth test"},
                     {{"unequal", "window", "close_pair", "interleaved"},
                      fails,
                      "four samples have five levels of coverage, and a near layer hides a far one in all samples that "
                      "both cover"},
                     {{"black", "white", "checker", "opaque_behind", "glass", "64_layers"},
                      fails,
                      "layers of equal alpha cover the same samples, so the nearest hides the others completely"},
                     {{"alpha_to_0", "one_layer"}, fails, "four samples have five levels of coverage"},
                     {{"opaque_between"}, passes, "one layer of 0.5 is two of four samples"},
                     {{"alpha_to_1", "leaves"},
                      passes,
                      "all samples are covered and the depth test decides in each: off by at most 1/128"},
                     {{"opaque_front"}, passes, "the depth test hides what is behind"}}}},
    };
}

}  // namespace sheer::test
