#include "tests/render/method_row.h"

namespace sheer::test {

namespace {

/// In each frame a pixel shows one surface, with independent thresholds each as often as its weight.
Bound frames_noise(const nlohmann::json& parameters) {
    return [=](const Stack& stack, PixelFormat format) {
        return mean_bound(sample_variance(stack), parameters.value("frames", 1)) + step_of(format);
    };
}

nlohmann::json independent(int frames) {
    return {{"hash", "position_and_primitive"}, {"frames", frames}};
}

}  // namespace

MethodRow row_hashed_alpha() {
    return {
        .id = "hashed_alpha",
        .formula = [](const nlohmann::json&) -> Formula { return over_by_depth; },
        .noise = frames_noise,
        .variants = {{independent(256), frames_noise(independent(256)), false, 64}},
        .litmus =
            {{"hashed_alpha, independent layers",
              {independent(4096)},
              {{{"shuffled"}, passes, "in each frame the nearest fragment over its threshold wins by the depth test"},
               {{"overflow"}, passes, "it sums nothing that could overflow; of one color, the layers have no order"},
               {{"self_overlap"}, passes, "the depth test decides per pixel"},
               {{"fade"},
                fails,
                "the inside of a model shows, as of any layers of that alpha: it does not know that they are one "
                "model"},
               {{"black", "white", "checker", "alpha_to_0", "one_layer", "64_layers", "unequal", "window", "close_pair",
                 "interleaved", "opaque_between", "opaque_behind"},
                passes,
                "a layer is seen in as many frames as no nearer one is, times its alpha: the over operator in the "
                "mean"},
               {{"alpha_to_1"}, passes, "alpha 1 always reaches its threshold, and less almost always"},
               {{"opaque_front"}, passes, "the depth test hides what is behind"},
               {{"glass", "leaves"}, passes, "the depth test decides per pixel"}}}},
    };
}

}  // namespace sheer::test
