// What the nearest k fragments are if their depths are equal, or if there are fewer or more of them.
#include "tests/render/render_test.h"

namespace sheer::test::nearest_k_test {

namespace {

using nlohmann::json;

json layer(double depth, const std::array<double, 3>& color) {
    return {{"rect", {0, 0, 1, 1}}, {"depth", depth}, {"color", color}, {"alpha", 0.4}};
}

std::array<float, 3> pixel_of(const json& layers, json method) {
    method["id"] = "nearest_k";
    const auto context = make_context("egl");
    const Spec spec = make_spec({{"type", "layers"}, {"layers", layers}}, json::array({method}), 4, "rgba32f");
    Stage stage(*context, spec, spec.image.format);
    const Image image = stage.picture(spec.methods[0]);
    return {image.pixel(2, 1)[0], image.pixel(2, 1)[1], image.pixel(2, 1)[2]};
}

/// Each of two layers of alpha 0.4, which let 153/255 = 0.6 through, is in front of the other to one half: they are
/// seen with (1 + 0.6) / 2 = 0.8, and what is behind with 0.36.
TEST(NearestK, FragmentsOfEqualDepthShareWhatReachesThem) {
    const json red_and_green = {layer(0.5, {1, 0, 0}), layer(0.5, {0, 1, 0})},
               green_and_red = {layer(0.5, {0, 1, 0}), layer(0.5, {1, 0, 0})};
    for (const json& layers : {red_and_green, green_and_red}) {
        const std::array<float, 3> pixel = pixel_of(layers, json::object());
        EXPECT_NEAR(pixel[0], 0.8 * 0.4 + 0.36 * 0.2, 1e-6);
        EXPECT_NEAR(pixel[1], 0.8 * 0.4 + 0.36 * 0.4, 1e-6);
        EXPECT_NEAR(pixel[2], 0.36 * 0.6, 1e-6);
    }
}

/// Red, green and blue from near to far over (0.2, 0.4, 0.6), with k = 1: red 0.4, and 0.6 of what becomes of the rest.
TEST(NearestK, TreatsTheRestAsAskedFor) {
    const json layers = {layer(0.7, {0, 0, 1}), layer(0.3, {1, 0, 0}), layer(0.5, {0, 1, 0})};
    const std::array<float, 3> dropped = pixel_of(layers, {{"k", 1}, {"rest", "dropped"}}),
                               darkened = pixel_of(layers, {{"k", 1}, {"rest", "transmittance"}}),
                               averaged = pixel_of(layers, {{"k", 1}}), kept = pixel_of(layers, {{"k", 3}});
    EXPECT_NEAR(dropped[1], 0.6 * 0.4, 1e-6);
    EXPECT_NEAR(darkened[1], 0.6 * 0.36 * 0.4, 1e-6) << "two layers of 0.4 let 0.36 through";
    EXPECT_NEAR(averaged[1], 0.6 * (0.36 * 0.4 + 0.64 * 0.5), 1e-6) << "their average is half green";
    EXPECT_NEAR(kept[1], 0.6 * 0.4 + 0.216 * 0.4, 1e-6);
    EXPECT_NEAR(dropped[0], 0.4 + 0.6 * 0.2, 1e-6);
    EXPECT_NEAR(averaged[0], 0.4 + 0.6 * 0.36 * 0.2, 1e-6);
}

}  // namespace

}  // namespace sheer::test::nearest_k_test
