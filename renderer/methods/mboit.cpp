// Moment-based order-independent transparency: Münstermann, Krumpen, Klein, Peters, Moment-Based Order-Independent
// Transparency, PACMCGIT 1(1), 2018. The absorbance of the fragments, -ln(1 - A_i), and its power moments over the
// depth are summed in any order. From them follow bounds of the absorbance in front of each depth; where between the
// two a fragment is taken to lie is the overestimation. The mean color, weighted with the transmittance in front, has
// the exact opacity. The depth goes from -1 at the near to 1 at the far plane, which here fit the scene; the paper's is
// the logarithm of the distance. An alpha of 1 would be an infinite absorbance, so there is a greatest one: 10 as in
// the authors' code. With 16 bits the moments are summed in half floats, which blend on any device, where the paper
// quantizes means of moments to 16 bits, for which a fragment has to read what is there; the biases are the paper's.
#include "renderer/methods/shared/two_pass_blending.h"

namespace sheer {

namespace {

struct MboitParameters {
    enum class Kind { power, trigonometric };
    enum class Precision { float32, float16 };

    int moments = 4;
    Kind kind = Kind::power;
    Precision precision = Precision::float32;
    double overestimation = 0.25;
    double bias_scale = 1;
    double greatest_absorbance = 10;

    static ParamTable<MboitParameters> table() {
        return ParamTable<MboitParameters>()
            .integer(&MboitParameters::moments, "moments",
                     "4, 6 or 8 numbers: power moments, or the real and imaginary parts of half as many trigonometric "
                     "ones",
                     "", 4, 8)
            .in_steps_of(2)
            .choice(&MboitParameters::kind, "kind",
                    "moments of the powers of the depth, or of e to the power of i times an angle that grows with it",
                    {{"power", Kind::power}, {"trigonometric", Kind::trigonometric}})
            .choice(&MboitParameters::precision, "precision",
                    "of the moments: float16 halves their memory and needs larger biases, so layers show through each "
                    "other sooner",
                    {{"float32", Precision::float32}, {"float16", Precision::float16}})
            .number(
                &MboitParameters::overestimation, "overestimation",
                "the part of a fragment's own absorbance that is taken to be in front of it: 0 is the least that the "
                "moments allow, 1 the most",
                "", 0, 1)
            .number(
                &MboitParameters::bias_scale, "bias_scale",
                "factor of the authors' bias, which for 4, 6 and 8 moments is 5e-7, 5e-6 and 5e-5, for trigonometric "
                "ones 4e-7, 8e-7 and 1.5e-6; with 16 bits 6e-5, 6e-4 and 2.5e-3, and 4e-4, 6.5e-4 and 8.5e-4",
                "", 0.01, 1000)
            .number(&MboitParameters::greatest_absorbance, "greatest_absorbance",
                    "the most that one fragment absorbs, as a natural logarithm", "", 1, 80);
    }
    double bias() const {
        const double biases[2][2][3] = {{{5e-7, 5e-6, 5e-5}, {4e-7, 8e-7, 1.5e-6}},
                                        {{6e-5, 6e-4, 2.5e-3}, {4e-4, 6.5e-4, 8.5e-4}}};
        return bias_scale * biases[is_half() ? 1 : 0][kind == Kind::power ? 0 : 1][moments / 2 - 2];
    }
    bool is_half() const { return precision == Precision::float16; }
};

class Mboit : public TwoPassBlending {
  public:
    Mboit(const MethodSetup& setup, const MboitParameters& parameters)
        : TwoPassBlending(setup, {.label = "mboit",
                                  .textures = textures(parameters),
                                  .generate = generate_source(parameters),
                                  .blend = blend_source(parameters),
                                  .prolog = prolog(parameters)}) {
        generate().set("u_greatest_absorbance", static_cast<float>(parameters.greatest_absorbance));
        blend().set("u_bias", static_cast<float>(parameters.bias()));
        blend().set("u_overestimation", static_cast<float>(parameters.overestimation));
    }

  private:
    static bool is_power(const MboitParameters& parameters) { return parameters.kind == MboitParameters::Kind::power; }

    static std::string generate_source(const MboitParameters& parameters) {
        return (is_power(parameters) ? "" : gl::shader_file("methods/mboit_circle.glsl")) +
               gl::shader_file("methods/mboit_generate.glsl");
    }

    static std::string blend_source(const MboitParameters& parameters) {
        const std::string kind = is_power(parameters) ? gl::shader_file("methods/mboit_power.glsl")
                                                      : gl::shader_file("methods/mboit_circle.glsl") +
                                                            gl::shader_file("methods/mboit_trigonometric.glsl");
        return gl::shader_file("methods/mboit_inputs.glsl") + kind + gl::shader_file("methods/mboit_blend.glsl");
    }

    static std::string prolog(const MboitParameters& parameters) {
        return "#define SHEER_MOMENTS " + std::to_string(parameters.moments) + "\n#define SHEER_TRIGONOMETRIC " +
               (is_power(parameters) ? "0" : "1") + "\n";
    }

    static std::vector<SumTexture> textures(const MboitParameters& parameters) {
        const GLenum format = parameters.is_half() ? GL_RGBA16F : GL_RGBA32F;
        std::vector<SumTexture> all = {{.name = "absorbance", .format = GL_R32F},
                                       {.name = "moments_0", .format = format}};
        if (parameters.moments > 4) all.push_back({.name = "moments_1", .format = format});
        return all;
    }
};

}  // namespace

MethodInfo method_mboit() {
    return describe_method(
        {
            .id = "mboit",
            .name = "MBOIT",
            .kind = "order-independent, approximate",
            .summary =
                "Moment-based order-independent transparency: a few moments of the absorbance over depth tell how "
                "much is in front of each fragment.",
            .paper = "Muenstermann, Krumpen, Klein, Peters, Moment-Based Order-Independent Transparency, PACMCGIT "
                     "1(1), 2018",
            .good_at =
                "Any number of layers without sorting and without popping; with overestimation 0 exact for half as "
                "many layers as moments and one more, and with equal alphas for any overestimation.",
            .bad_at =
                "Where moments do not suffice, layers show through each other, and with overestimation above 0 through "
                "opaque ones; the second pass computes much for each fragment.",
            .memory = "40 bytes per pixel, 56 with 6 or 8 moments; 8 and 16 fewer with float16",
            .passes = "2, and a full-screen one",
            .needs = "float targets with blending",
            .needs_sorting = false,
        },
        MboitParameters::table(), make_new<Mboit>, [](const MboitParameters& parameters, int) -> std::optional<double> {
            const int textures = parameters.moments > 4 ? 2 : 1;
            return 24 + textures * (parameters.is_half() ? 8 : 16);
        });
}

}  // namespace sheer
