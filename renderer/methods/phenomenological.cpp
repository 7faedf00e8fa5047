// Transmission and coverage of McGuire and Mara, Phenomenological Transparency, IEEE TVCG 23(5), 2017 (first in A
// Phenomenological Scattering Model for Order-Independent Transparency, I3D 2016); its refraction, diffusion and
// shadows are left out. The light from behind is multiplied by a color for each fragment, 1 - A_i (1 - t_i), in any
// order; what the fragments reflect is averaged with weights, as in WBOIT, by their net coverage A_i (1 - mean of t_i):
//   (sum w A_i R_i / sum w N_i) (1 - M) + D M,  M = prod (1 - A_i (1 - t_i)) for each channel
// Scenes here give a fragment one color C and a coverage A. The parameter divides C into t = transmission C and
// R = (1 - transmission) C.
#include "renderer/methods/shared/blended_sums.h"

namespace sheer {

namespace {

struct PhenomenologicalParameters {
    double transmission = 0;

    static ParamTable<PhenomenologicalParameters> table() {
        return ParamTable<PhenomenologicalParameters>().number(
            &PhenomenologicalParameters::transmission, "transmission",
            "the part of its color that a fragment transmits, tinting what is behind; the rest it reflects. 0: "
            "coverage "
            "alone, 1: colored glass",
            "", 0, 1);
    }
};

class Phenomenological : public BlendedSums {
  public:
    Phenomenological(const MethodSetup& setup, const PhenomenologicalParameters& parameters)
        : BlendedSums(setup, {.label = "phenomenological",
                              .textures = {{.name = "sums", .format = four_channel_sums(setup.target)},
                                           {.name = "modulation",
                                            .format = four_channel_sums(setup.target),
                                            .empty = 1,
                                            .source_factor = GL_ZERO,
                                            .target_factor = GL_ONE_MINUS_SRC_COLOR}},
                              .accumulate = "methods/phenomenological_accumulate.glsl",
                              .composite = "methods/phenomenological_composite.glsl"}) {
        accumulate().set("u_transmission", static_cast<float>(parameters.transmission));
    }

    std::vector<PixelFact> explain(const PixelTrace& trace) const override {
        const glm::vec4 sums = sum_at(trace, 0);
        return {color_fact("reflected_sum", glm::vec3(sums),
                           "The sum over all fragments of weight times coverage times reflected color."),
                number_fact("weight_sum", sums.a, "The sum of weight times net coverage, by which it is divided."),
                color_fact("modulation", glm::vec3(sum_at(trace, 1)),
                           "What all fragments together let through of the opaque color, in each channel.")};
    }
};

}  // namespace

MethodInfo method_phenomenological() {
    return describe_method(
        {
            .id = "phenomenological",
            .name = "Phenomenological",
            .kind = "order-independent, approximate",
            .summary =
                "Coverage and colored transmission apart: fragments tint what is behind them, and their own colors "
                "are averaged with weights.",
            .paper = "McGuire and Mara, Phenomenological Transparency, IEEE TVCG 23(5), 2017",
            .good_at =
                "Colored glass in one pass without sorting: the light through it has the right color for any number "
                "of layers.",
            .bad_at =
                "Far layers show through opaque near ones. With transmission above 0 the picture is another one than "
                "alpha blending gives, and its error against it says nothing about glass.",
            .memory = "16 bytes per pixel, 32 with rgba32f",
            .passes = "1, and a full-screen one",
            .needs = "half-float targets, each with its own blend factors",
            .needs_sorting = false,
        },
        PhenomenologicalParameters::table(), make_new<Phenomenological>,
        [](const auto&, int pixel_bytes) -> std::optional<double> { return pixel_bytes == 16 ? 32 : 16; });
}

}  // namespace sheer
