// How often dual depth peeling draws the scene, and fragments of equal depth.
#include "tests/render/formulas.h"
#include "tests/render/render_test.h"

namespace sheer::test::dual_depth_peeling_test {

namespace {

using nlohmann::json;

json layer(double depth, const Color& color, double alpha) {
    return {{"rect", {0, 0, 1, 1}}, {"depth", depth}, {"color", color}, {"alpha", alpha}, {"opaque", false}};
}

int passes_for(gl::Context& context, int count) {
    json layers = json::array();
    for (int i = 0; i < count; ++i) layers.push_back(layer(0.05 + 0.05 * i, {1, 1, 1}, 0.5));
    const Spec spec = make_spec({{"type", "layers"}, {"layers", layers}}, {"dual_depth_peeling"}, 4);
    NoAssets assets;
    const Scene scene(context.gl(), build_geometry(spec.scene, spec.image, assets), spec.scene);
    const Target target(context.gl(), spec.image, spec.image.format);
    gl::FrameTimer timer(context);
    const auto method =
        find_method("dual_depth_peeling")->make({context, context.gl(), scene, target}, spec.methods[0].parameters);
    gl::FrameTimer::Frame frame = timer.frame(false);
    method->render(timer);
    frame.end();
    return method->findings(timer)["peeling"]["passes"];
}

/// The first only finds the outermost depths; each other one takes two layers, the last one the one in the middle.
TEST(DualDepthPeeling, NeedsOnePassForTwoLayersAndOneMore) {
    const auto context = make_context("egl");
    for (const int count : {1, 2, 3, 4, 7, 8, 16}) EXPECT_EQ(passes_for(*context, count), (count + 1) / 2 + 1) << count;
}

/// Fragments of equal depth are nearest, between others, farthest, and all there are; the one submitted later is
/// nearer.
TEST(DualDepthPeeling, LosesNoneOfEqualDepth) {
    const auto context = make_context("egl");
    const Color red = {1, 0, 0}, green = {0, 1, 0}, blue = {0, 0, 1}, gray = {0.5, 0.5, 0.5};
    const std::vector<std::vector<double>> depths = {
        {0.2, 0.2, 0.2, 0.8}, {0.2, 0.8, 0.8, 0.8}, {0.1, 0.5, 0.5, 0.9}, {0.4, 0.4, 0.4, 0.4}, {0.3, 0.6, 0.3, 0.6}};
    for (const std::vector<double>& at : depths) {
        const json layers = {layer(at[0], red, 0.3), layer(at[1], green, 0.6), layer(at[2], blue, 0.45),
                             layer(at[3], gray, 0.7)};
        const json of_layers = {{"type", "layers"}, {"layers", layers}};
        const Spec spec = make_spec(of_layers, {"dual_depth_peeling"}, 4, "rgba32f");
        const Color expected = Compositor(of_layers, 4, {0.2, 0.4, 0.6}).pixel(1, 1, over_by_depth);
        Stage stage(*context, spec, spec.image.format);
        const Image image = stage.picture(spec.methods[0]);
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(image.pixel(1, 1)[channel], expected[static_cast<std::size_t>(channel)], 1e-6)
                << json(at).dump() << channel;
    }
}

}  // namespace

}  // namespace sheer::test::dual_depth_peeling_test
