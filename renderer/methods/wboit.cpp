// Weighted, blended order-independent transparency: McGuire and Bavoil, Weighted Blended Order-Independent
// Transparency, JCGT 2(2), 2013. Equation 6, with the weights w of equations 7 to 10, which fall with the depth:
//   (sum w A_i C_i / sum w A_i) (1 - prod (1 - A_i)) + D prod (1 - A_i)
// The weights reach 3,000, a 16-bit float 65,504: from 22 near layers of alpha 1 on, the sums overflow.
#include <algorithm>

#include "renderer/methods/shared/blended_sums.h"

namespace sheer {

namespace {

constexpr float largest_in_16_bits = 65504;

struct WboitParameters {
    enum class Weight { equal = 0, eq7 = 7, eq8 = 8, eq9 = 9, eq10 = 10 };

    Weight weight = Weight::eq10;
    double depth_scale = 1;
    double alpha_scale = 1;
    double least_weight = 1e-2;
    double greatest_weight = 3e3;

    static ParamTable<WboitParameters> table() {
        return ParamTable<WboitParameters>()
            .choice(
                &WboitParameters::weight, "weight",
                "the paper's equation for the weight: of the distance from the camera (eq7, eq8, eq9: for 0.1 to 500 "
                "units), of the depth in the depth buffer (eq10), or the same for every fragment (equal)",
                {{"eq7", Weight::eq7},
                 {"eq8", Weight::eq8},
                 {"eq9", Weight::eq9},
                 {"eq10", Weight::eq10},
                 {"equal", Weight::equal}})
            .number(&WboitParameters::depth_scale, "depth_scale",
                    "eq7 to eq9: factor of the distance, which brings it into their range", "", 1e-6, 1e6)
            .number(&WboitParameters::alpha_scale, "alpha_scale",
                    "eq7 to eq10: factor of the alpha in the weight, which is then cut at 1", "", 1e-3, 1e3)
            .number(&WboitParameters::least_weight, "least_weight",
                    "eq7 to eq10: the part of the weight that depends on depth is at least this", "", 1e-6, 1)
            .number(&WboitParameters::greatest_weight, "greatest_weight",
                    "eq7 to eq10: and at most this; the sums overflow later the lower it is", "", 1, 1e5);
    }
};

class Wboit : public BlendedSums {
  public:
    Wboit(const MethodSetup& setup, const WboitParameters& parameters)
        : BlendedSums(setup, {.label = "wboit",
                              .textures = {{.name = "sums", .format = four_channel_sums(setup.target)},
                                           {.name = "revealage",
                                            .format = one_channel_sums(setup.target),
                                            .empty = 1,
                                            .source_factor = GL_ZERO,
                                            .target_factor = GL_ONE_MINUS_SRC_COLOR}},
                              .accumulate = "methods/wboit_accumulate.glsl",
                              .composite = "methods/wboit_composite.glsl",
                              .prolog = "#define SHEER_EQUATION " +
                                        std::to_string(static_cast<int>(parameters.weight)) + "\n"}) {
        accumulate().set("u_depth_scale", static_cast<float>(parameters.depth_scale));
        accumulate().set("u_alpha_scale", static_cast<float>(parameters.alpha_scale));
        accumulate().set("u_least_weight", static_cast<float>(parameters.least_weight));
        accumulate().set("u_greatest_weight", static_cast<float>(parameters.greatest_weight));
    }

    /// {"sums": {"overflowed_pixels", "greatest"}}: the pixels whose sum of weights does not fit into 16 bits, and
    /// which so have lost their color; the greatest sum of the others. Devices round such a sum to infinity or to the
    /// largest number.
    nlohmann::json findings(gl::FrameTimer& timer) override {
        render(timer);
        std::int64_t overflowed = 0;
        double greatest = 0;
        for (const glm::vec4& pixel : read_sum(0)) {
            if (m_target.format() == PixelFormat::rgba32f || pixel.a < largest_in_16_bits) {
                greatest = std::max(greatest, double{pixel.a});
            } else {
                ++overflowed;
            }
        }
        return {{"sums", {{"overflowed_pixels", overflowed}, {"greatest", greatest}}}};
    }

    std::vector<PixelFact> explain(const PixelTrace& trace) const override {
        const glm::vec4 sums = sum_at(trace, 0);
        return {
            color_fact("color_sum", glm::vec3(sums), "The sum over all fragments of weight times alpha times color."),
            number_fact("weight_sum", sums.a, "The sum of weight times alpha, by which color_sum is divided."),
            number_fact("opaque_weight", sum_at(trace, 1).r,
                        "The weight of the opaque color, the product of one minus each alpha.")};
    }
};

}  // namespace

MethodInfo method_wboit() {
    return describe_method(
        {
            .id = "wboit",
            .name = "WBOIT",
            .kind = "order-independent, approximate",
            .summary = "Weighted blended order-independent transparency: a mean color, in which near fragments count "
                       "more, over the exact part of the background.",
            .paper = "McGuire and Bavoil, Weighted Blended Order-Independent Transparency, JCGT 2(2), 2013",
            .good_at =
                "One pass without sorting, no popping; the background shows through exactly as much as it should.",
            .bad_at = "The weights have to fit the scene's depths. Far layers show through opaque near ones, and sums "
                      "in 16-bit "
                      "floats overflow to black from about 22 near layers of alpha 1 on: lower greatest_weight.",
            .memory = "10 bytes per pixel, 20 with rgba32f",
            .passes = "1, and a full-screen one",
            .needs = "half-float targets, each with its own blend factors",
            .needs_sorting = false,
        },
        WboitParameters::table(), make_new<Wboit>,
        [](const auto&, int pixel_bytes) -> std::optional<double> { return pixel_bytes == 16 ? 20 : 10; });
}

}  // namespace sheer
