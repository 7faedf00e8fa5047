// The grain of hashed alpha testing: how much of a surface it shows, and where.
#include <cmath>

#include "tests/render/render_test.h"

namespace sheer::test::hashed_alpha_test {

namespace {

using nlohmann::json;

constexpr int size_px = 64;
constexpr double pixels = size_px * size_px;

json layer(double depth, double alpha) {
    return {{"rect", {0, 0, 1, 1}}, {"depth", depth}, {"color", {1, 1, 1}}, {"alpha", alpha}};
}

Image picture_of(const json& layers, json method) {
    method["id"] = "hashed_alpha";
    const auto context = make_context("egl");
    const Spec spec = make_spec({{"type", "layers"}, {"layers", layers}}, json::array({method}), size_px);
    Stage stage(*context, spec, spec.image.format);
    return stage.picture(spec.methods[0]);
}

/// The share of pixels that show a white layer, and not the background (0.2, 0.4, 0.6).
double coverage(const Image& image) {
    double shown = 0;
    for (int y = 0; y < image.height_px; ++y)
        for (int x = 0; x < image.width_px; ++x) shown += image.pixel(x, y)[0] == 1.0f ? 1 : 0;
    return shown / (image.width_px * image.height_px);
}

/// Each pixel is a grain of its own here, shown with the probability alpha: in the mean alpha, with the standard
/// deviation sqrt(alpha (1 - alpha) / n).
TEST(HashedAlpha, ShowsAsMuchAsItsAlphaSays) {
    for (const double alpha : {1.0 / 64, 0.1, 0.25, 0.5, 0.8, 63.0 / 64})
        for (const int seed : {0, 1, 2})
            EXPECT_NEAR(coverage(picture_of(json::array({layer(0.5, alpha)}), {{"seed", seed}})), alpha,
                        4 * std::sqrt(alpha * (1 - alpha) / pixels))
                << alpha << ", seed " << seed;
}

TEST(HashedAlpha, NeverShowsAlpha0AndAlwaysShowsAlpha1) {
    EXPECT_EQ(coverage(picture_of(json::array({layer(0.5, 0)}), {{"frames", 16}})), 0);
    EXPECT_EQ(coverage(picture_of(json::array({layer(0.5, 1)}), {{"frames", 16}})), 1);
}

/// Two layers of alpha 0.5 in one grain: the paper's hash of the place shows both or none, independent thresholds show
/// one of them in three of four pixels.
TEST(HashedAlpha, LayersInOneGrainAreOnlyIndependentWithTheirPrimitives) {
    const json layers = {layer(0.5, 0.5), layer(0.5 + 1.0 / 512, 0.5)};
    const double deviation = std::sqrt(0.25 / pixels);
    EXPECT_NEAR(coverage(picture_of(layers, {{"hash", "position"}})), 0.5, 4 * deviation);
    EXPECT_NEAR(coverage(picture_of(layers, {{"hash", "position_and_primitive"}})), 0.75, 4 * deviation);
}

/// A grain of four pixels: neighbours within it are shown together.
TEST(HashedAlpha, GrainsHaveTheirSize) {
    const Image image = picture_of(json::array({layer(0.5, 0.5)}), {{"hash_scale", 4}});
    for (int y = 0; y < size_px; ++y)
        for (int x = 0; x < size_px; ++x)
            EXPECT_EQ(image.pixel(x, y)[0], image.pixel(x - x % 4, y - y % 4)[0]) << x << ' ' << y;
    EXPECT_NEAR(coverage(image), 0.5, 4 * std::sqrt(0.25 / (pixels / 16)));
}

TEST(HashedAlpha, IsTheSamePictureInEachFrameOfAStillScene) {
    const Image a = picture_of(json::array({layer(0.5, 0.5)}), {{"seed", 3}}),
                b = picture_of(json::array({layer(0.5, 0.5)}), {{"seed", 3}});
    EXPECT_EQ(greatest_difference(a, b), 0);
    EXPECT_GT(greatest_difference(a, picture_of(json::array({layer(0.5, 0.5)}), {{"seed", 4}})), 0);
}

}  // namespace

}  // namespace sheer::test::hashed_alpha_test
