// Which fragments the marks stop, and what that does to the picture.
#include "tests/render/sample_count.h"

namespace sheer::test::depth_marks_test {

namespace {

constexpr int size_px = 16;
constexpr int pixels = size_px * size_px;

nlohmann::json marks(int interval, double threshold) {
    return {{"id", "depth_marks"}, {"interval", interval}, {"threshold", threshold}};
}

nlohmann::json half_layers(int count) {
    nlohmann::json layers = nlohmann::json::array();
    for (int i = 0; i < count; ++i) layers.push_back(full_layer(0.1 + 0.05 * i, {1, 1, 1}, 0.5));
    return layers_scene(layers);
}

/// Samples per pixel of a frame whose pixels are all equal.
std::int64_t samples_per_pixel(const nlohmann::json& scene, const nlohmann::json& method) {
    const auto context = make_context("egl");
    const Spec spec = make_spec(scene, nlohmann::json::array({method}), size_px);
    Stage stage(*context, spec, PixelFormat::rgba8);
    const auto made = stage.make(spec.methods[0]);
    const std::int64_t samples = samples_of_frame(*context, stage, *made);
    EXPECT_EQ(samples % pixels, 0);
    return samples / pixels;
}

/// Layers of alpha 0.5 leave 0.5, 0.25, 0.125, 0.0625, ... of the light. Every pixel is marked at most once, and the
/// composite is one sample more.
TEST(DepthMarks, ShadeUpToTheNextMark) {
    const int composite = 1, mark = 1;
    // A threshold of 0.2 is passed by the third layer: marked at once, after the fourth, after the fifth, or never.
    EXPECT_EQ(samples_per_pixel(half_layers(10), marks(1, 0.2)), 3 + mark + composite);
    EXPECT_EQ(samples_per_pixel(half_layers(10), marks(2, 0.2)), 4 + mark + composite);
    EXPECT_EQ(samples_per_pixel(half_layers(10), marks(5, 0.2)), 5 + mark + composite);
    EXPECT_EQ(samples_per_pixel(half_layers(10), marks(10, 0.2)), 10 + composite);
    // The threshold decides how many: 0.6 is passed by the first layer, 0.05 by the fifth, 0 by none.
    EXPECT_EQ(samples_per_pixel(half_layers(10), marks(1, 0.6)), 1 + mark + composite);
    EXPECT_EQ(samples_per_pixel(half_layers(10), marks(1, 0.05)), 5 + mark + composite);
    EXPECT_EQ(samples_per_pixel(half_layers(10), marks(1, 0)), 10 + composite);
}

/// 0.5 of white, then green stopped by the mark: what is left out is 0.5 x 0.8 of green, and the background has its
/// 0.5 instead. With alpha 1 in front nothing is left to show, and the picture does not change.
TEST(DepthMarks, LeaveOutExactlyWhatIsBehindTheMark) {
    const auto context = make_context("egl");
    for (const double alpha : {0.5, 1.0}) {
        const nlohmann::json layers = {full_layer(0.7, {0, 1, 0}, 0.8), full_layer(0.2, {1, 1, 1}, alpha)};
        const Spec spec = make_spec(layers_scene(layers), {marks(1, 0.51), marks(2, 0.51)}, size_px, "rgba32f");
        Stage stage(*context, spec, PixelFormat::rgba32f);
        const Image stopped = stage.picture(spec.methods[0]), whole = stage.picture(spec.methods[1]);
        const double left = 1 - alpha;
        const std::array background = {0.2, 0.4, 0.6}, green = {0.0, 1.0, 0.0};
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(stopped.pixel(3, 5)[i], alpha + left * background[i], 1e-6);
            EXPECT_NEAR(whole.pixel(3, 5)[i], alpha + left * (0.8 * green[i] + 0.2 * background[i]), 1e-6);
        }
    }
}

TEST(DepthMarks, ErrorIsAtMostTheThreshold) {
    const auto context = make_context("egl");
    const nlohmann::json quads = {
        {"type", "quads"}, {"count", 200}, {"shading", "4x4-textures"}, {"texture", {{"image", "leaf"}, {"size", 64}}}};
    for (const double threshold : {0.01, 0.1, 0.5}) {
        const Spec spec = make_spec(quads, {"f2b", marks(7, threshold)}, 64, "rgba32f");
        Stage stage(*context, spec, PixelFormat::rgba32f);
        const double difference = greatest_difference(stage.picture(spec.methods[0]), stage.picture(spec.methods[1]));
        EXPECT_LE(difference, threshold + 1e-5) << threshold;
        EXPECT_GT(difference, 0) << "nothing was stopped";
    }
}

/// The marks are in the depth of the opaque pass. They must not outlive the frame or be mistaken for opaque geometry.
TEST(DepthMarks, RespectOpaqueGeometryInEveryFrame) {
    const auto context = make_context("egl");
    const nlohmann::json layers = {
        full_layer(0.6, {0, 0, 1}, 1, true),  // shows through what is in front of it
        full_layer(0.8, {0, 1, 0}, 0.9),      // hidden by it
        full_layer(0.3, {1, 0, 0}, 0.75),     // leaves 0.25
        full_layer(0.4, {0, 1, 0}, 0.5),      // stopped
    };
    const Spec spec = make_spec(layers_scene(layers), nlohmann::json::array({marks(1, 0.3)}), size_px, "rgba32f");
    Stage stage(*context, spec, PixelFormat::rgba32f);
    const auto method = stage.make(spec.methods[0]);
    for (int frame = 0; frame < 3; ++frame) {
        stage.frame(*method);
        const Image image = stage.target().read();
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(image.pixel(8, 8)[i], (std::array{0.75, 0.0, 0.25}[i]), 1e-6) << frame;
    }
}

}  // namespace

}  // namespace sheer::test::depth_marks_test
