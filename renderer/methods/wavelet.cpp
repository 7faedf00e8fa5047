// Wavelet transparency: Aizenshtein, Smal, McGuire, Wavelet Transparency, 2022 (arXiv 2201.00094). The absorbance up to
// a depth z, sum of -ln(1 - A_i) over the fragments in front, is a staircase. Its projection on the Haar basis of rank
// R, 2^(R + 1) functions between the near and the far plane, which here fit the scene, is a sum over the fragments in
// any order. What a fragment is seen through is reconstructed from it: the mean of the staircase over the fragment's
// cell and the one before, interpolated between the two. So fragments of one cell do not hide each other as they
// should. The opaque color gets its exact weight. An alpha of 1 would be an infinite absorbance, so there is a greatest
// one: 10 lets 1/22000 through.
#include "renderer/methods/shared/two_pass_blending.h"

namespace sheer {

namespace {

struct WaveletParameters {
    int rank = 3;
    double greatest_absorbance = 10;

    static ParamTable<WaveletParameters> table() {
        return ParamTable<WaveletParameters>()
            .integer(&WaveletParameters::rank, "rank", "2 to the power of rank + 1 cells of depth", "", 1, 4)
            .number(&WaveletParameters::greatest_absorbance, "greatest_absorbance",
                    "the most that one fragment absorbs, as a natural logarithm", "", 1, 80);
    }
};

class Wavelet : public TwoPassBlending {
  public:
    Wavelet(const MethodSetup& setup, const WaveletParameters& parameters)
        : TwoPassBlending(setup, {.label = "wavelet",
                                  .textures = textures(parameters),
                                  .generate = source("generate"),
                                  .blend = source("blend"),
                                  .prolog = prolog(parameters)}) {
        generate().set("u_greatest_absorbance", static_cast<float>(parameters.greatest_absorbance));
    }

  private:
    static int targets(const WaveletParameters& parameters) { return (2 << parameters.rank) / 4; }

    static std::vector<SumTexture> textures(const WaveletParameters& parameters) {
        std::vector<SumTexture> all;
        for (int i = 0; i < targets(parameters); ++i)
            all.push_back({.name = "coefficients_" + std::to_string(i), .format = GL_RGBA32F});
        return all;
    }

    static std::string source(const std::string& pass) {
        return gl::shader_file("methods/wavelet_basis.glsl") + gl::shader_file("methods/wavelet_" + pass + ".glsl");
    }

    static std::string prolog(const WaveletParameters& parameters) {
        return "#define SHEER_COEFFICIENTS " + std::to_string(2 << parameters.rank) + "\n#define SHEER_TARGETS " +
               std::to_string(targets(parameters)) + "\n";
    }
};

}  // namespace

MethodInfo method_wavelet() {
    return describe_method(
        {
            .id = "wavelet",
            .name = "Wavelet transparency",
            .kind = "order-independent, approximate",
            .summary =
                "The absorbance over depth is summed as Haar wavelets; each fragment is weighted by what they say "
                "is in front of it.",
            .paper = "Aizenshtein, Smal, McGuire, Wavelet Transparency, 2022, arXiv 2201.00094",
            .good_at =
                "Many layers spread over the depth, without sorting; the background shows through exactly as much "
                "as it should.",
            .bad_at =
                "Layers in one cell of depth show through each other, even opaque ones; two passes over the scene "
                "and much memory.",
            .memory = "20 bytes per pixel and 16 for every four coefficients: 84 at rank 3",
            .passes = "2, and a full-screen one",
            .needs = "float targets with blending",
            .needs_sorting = false,
        },
        WaveletParameters::table(), make_new<Wavelet>,
        [](const WaveletParameters& parameters, int) -> std::optional<double> {
            return 20 + 4 * std::max(4, 2 << parameters.rank);
        });
}

}  // namespace sheer
