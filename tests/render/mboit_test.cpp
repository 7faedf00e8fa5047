// How many layers moments describe exactly.
#include "tests/render/formulas.h"
#include "tests/render/render_test.h"

namespace sheer::test::mboit_test {

namespace {

using nlohmann::json;

/// Full layers of these alphas, from near to far, in colors that differ from each other.
json layers_of(const std::vector<double>& alphas) {
    json layers = json::array();
    for (std::size_t i = 0; i < alphas.size(); ++i) {
        const auto place = static_cast<double>(i);
        layers.push_back({{"rect", {0, 0, 1, 1}},
                          {"depth", 0.1 + 0.8 * place / static_cast<double>(alphas.size())},
                          {"color", {i % 2 == 0 ? 0.9 : 0.1, 0.2 + 0.1 * place, i % 3 == 0 ? 0.1 : 0.8}},
                          {"alpha", alphas[i]},
                          {"opaque", false}});
    }
    return {{"type", "layers"}, {"layers", layers}};
}

/// The greatest difference from the correct color.
double error_of(const std::vector<double>& alphas, json method) {
    method["id"] = "mboit";
    const json scene = layers_of(alphas);
    const auto context = make_context("egl");
    const Spec spec = make_spec(scene, json::array({method}), 4, "rgba32f");
    const Color expected = Compositor(scene, 4, {0.2, 0.4, 0.6}).pixel(1, 1, over_by_depth);
    Stage stage(*context, spec, spec.image.format);
    const Image image = stage.picture(spec.methods[0]);
    double greatest = 0;
    for (std::size_t i = 0; i < 3; ++i) greatest = std::max(greatest, std::abs(image.pixel(1, 1)[i] - expected[i]));
    return greatest;
}

/// A distribution at h places is known from 2 h moments, and at one more if one of them is given, which is the
/// fragment's own. Rounding and bias are less than a level.
TEST(Mboit, IsExactForHalfAsManyLayersAsMomentsAndOneMore) {
    const std::vector<double> five = {0.3, 0.7, 0.2, 0.5, 0.4};
    for (const char* kind : {"power", "trigonometric"})
        for (const int moments : {4, 6, 8})
            for (int count = 1; count <= moments / 2 + 1; ++count)
                EXPECT_LT(error_of({five.begin(), five.begin() + count},
                                   {{"kind", kind}, {"moments", moments}, {"overestimation", 0}}),
                          1.0 / 255)
                    << moments << ' ' << kind << " moments, " << count << " layers";
    EXPECT_GT(error_of({0.3, 0.7, 0.2, 0.5, 0.4, 0.6, 0.3, 0.5}, {{"moments", 4}, {"overestimation", 0}}), 1.0 / 255);
}

/// The biases for half floats cost accuracy, but three layers stay near the correct color; the exact bound of each
/// picture's rounding is in the method's row.
TEST(Mboit, HalfFloatsAreNearForFewLayers) {
    for (const char* kind : {"power", "trigonometric"})
        for (const int moments : {4, 6, 8}) {
            const json method = {{"kind", kind}, {"moments", moments}, {"overestimation", 0}, {"precision", "float16"}};
            EXPECT_LT(error_of({0.5}, method), 1e-6) << "one layer is its own mean";
            const double error = error_of({0.3, 0.7, 0.2}, method);
            EXPECT_LT(error, 12.0 / 255) << moments << ' ' << kind;
            EXPECT_GT(error, 0) << moments << ' ' << kind;
        }
}

/// Each loses the same part to the overestimation, which the mean color does not show.
TEST(Mboit, IsExactForEqualAlphasAtAnyOverestimation) {
    for (const double overestimation : {0.0, 0.25, 1.0})
        EXPECT_LT(error_of({0.5, 0.5, 0.5}, {{"overestimation", overestimation}}), 1.0 / 255) << overestimation;
    EXPECT_GT(error_of({0.2, 0.7, 0.4}, {{"overestimation", 1}}), 6.0 / 255);
}

/// Its absorbance would be infinite: it counts as the greatest one, here as letting e^-10 through.
TEST(Mboit, ShowsAnAlphaOf1) {
    EXPECT_LT(error_of({1}, json::object()), 1e-6);
    EXPECT_LT(error_of({0.5, 1, 1}, {{"overestimation", 0}}), 1.0 / 255);
}

}  // namespace

}  // namespace sheer::test::mboit_test
