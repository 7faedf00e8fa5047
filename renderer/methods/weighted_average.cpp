// Weighted average: Bavoil and Myers, Order Independent Transparency with Dual Depth Peeling (NVIDIA 2008), section 3.
// The N fragments of a pixel are replaced by N equal ones of the average color and the average alpha a = (sum A_i) / N:
//   (sum A_i C_i / sum A_i) (1 - (1 - a)^N) + D (1 - a)^N
// Fragments of alpha 0 are dropped: they show nothing, but would count in N. A 16-bit float counts to 2,048.
#include "renderer/methods/shared/blended_sums.h"

namespace sheer {

namespace {

class WeightedAverage : public BlendedSums {
  public:
    WeightedAverage(const MethodSetup& setup, const NoParameters&)
        : BlendedSums(setup, {.label = "weighted average",
                              .textures = {{.name = "sums", .format = four_channel_sums(setup.target)},
                                           {.name = "count", .format = one_channel_sums(setup.target)}},
                              .accumulate = "methods/weighted_average_accumulate.glsl",
                              .composite = "methods/weighted_average_composite.glsl"}) {}

    std::vector<PixelFact> explain(const PixelTrace& trace) const override {
        const glm::vec4 sums = sum_at(trace, 0);
        const double rest = sums.a == 0 ? 1 : composite_at(trace, 1).r;
        return {color_fact("color_sum", glm::vec3(sums), "The sum over all fragments of alpha times color."),
                number_fact("alpha_sum", sums.a, "The sum of the alphas."),
                number_fact("count", sum_at(trace, 1).r, "N, the number of fragments with an alpha above 0."),
                number_fact("opaque_weight", rest, "The weight of the opaque color, (1 - alpha_sum / N) to the N.")};
    }
};

}  // namespace

MethodInfo method_weighted_average() {
    return describe_method(
        {
            .id = "weighted_average",
            .name = "Weighted average",
            .kind = "order-independent, approximate",
            .summary = "Each pixel shows as many equal layers as it has fragments, of their average color and alpha.",
            .paper =
                "Bavoil and Myers, Order Independent Transparency with Dual Depth Peeling, NVIDIA, 2008, section 3",
            .good_at = "One pass without sorting; exact for one layer, and for several of equal color and alpha.",
            .bad_at =
                "Near and far layers count alike, so a far one shows through an opaque near one. Where alphas differ, "
                "so does the transmittance: it is that of their average.",
            .memory = "10 bytes per pixel, 20 with rgba32f",
            .passes = "1, and a full-screen one",
            .needs = "half-float targets, each with its own blend factors",
            .needs_sorting = false,
        },
        NoParameters::table(), make_new<WeightedAverage>,
        [](const auto&, int pixel_bytes) -> std::optional<double> { return pixel_bytes == 16 ? 20 : 10; });
}

}  // namespace sheer
