// Luminous fragments: the operator `opaque` of Porter and Duff, Compositing Digital Images, SIGGRAPH 1984, section 4.5,
// scales what a premultiplied picture covers and leaves what it emits: (A C, w A). Light that is emitted is added, and
// what is behind is seen through the product of what the fragments let through, both in any order:
//   sum A_i C_i + D prod (1 - w A_i)
// With w = 0 that is additive blending of premultiplied colors, as fire and sparks are drawn. Only the result is
// clamped.
#include "renderer/methods/shared/blended_sums.h"

namespace sheer {

namespace {

struct PremultipliedAdditiveParameters {
    double coverage = 0;

    static ParamTable<PremultipliedAdditiveParameters> table() {
        return ParamTable<PremultipliedAdditiveParameters>().number(
            &PremultipliedAdditiveParameters::coverage, "coverage",
            "the part of the alpha that hides the opaque color: 0 for light alone, 1 for all of it", "", 0, 1);
    }
};

class PremultipliedAdditive : public BlendedSums {
  public:
    PremultipliedAdditive(const MethodSetup& setup, const PremultipliedAdditiveParameters& parameters)
        : BlendedSums(setup, {.label = "premultiplied additive",
                              .textures = {{.name = "sum", .format = four_channel_sums(setup.target)},
                                           {.name = "transmittance",
                                            .format = one_channel_sums(setup.target),
                                            .empty = 1,
                                            .source_factor = GL_ZERO,
                                            .target_factor = GL_ONE_MINUS_SRC_COLOR}},
                              .accumulate = "methods/premultiplied_additive_accumulate.glsl",
                              .composite = "methods/premultiplied_additive_composite.glsl"}) {
        accumulate().set("u_coverage", static_cast<float>(parameters.coverage));
    }

    std::vector<PixelFact> explain(const PixelTrace& trace) const override {
        return {
            color_fact("color_sum", glm::vec3(sum_at(trace, 0)), "The sum over all fragments of alpha times color."),
            number_fact("opaque_weight", sum_at(trace, 1).r, "The part of the opaque color that is not covered.")};
    }
};

}  // namespace

MethodInfo method_premultiplied_additive() {
    return describe_method(
        {
            .id = "premultiplied_additive",
            .name = "Premultiplied additive",
            .kind = "order-independent, approximate",
            .summary = "The light of all fragments is added; how much they cover is a parameter of its own.",
            .paper = "Porter and Duff, Compositing Digital Images, SIGGRAPH 1984, section 4.5 (the operator opaque)",
            .good_at = "Fire, sparks and glow, in one pass without sorting: exact for what emits light and hides none.",
            .bad_at =
                "Fragments do not hide each other, so many of them turn white. With coverage 0 nothing darkens the "
                "background.",
            .memory = "10 bytes per pixel, 20 with rgba32f",
            .passes = "1, and a full-screen one",
            .needs = "half-float targets, each with its own blend factors",
            .needs_sorting = false,
        },
        PremultipliedAdditiveParameters::table(), make_new<PremultipliedAdditive>,
        [](const auto&, int pixel_bytes) -> std::optional<double> { return pixel_bytes == 16 ? 20 : 10; });
}

}  // namespace sheer
