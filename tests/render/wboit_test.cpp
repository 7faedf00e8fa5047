// WBOIT where its sums reach the end of the 16-bit floats.
#include "tests/render/render_test.h"

namespace sheer::test::wboit_test {

namespace {

using nlohmann::json;

/// 30 green layers of alpha 1 at depth 1/1000, whose weight is 3000 * 0.999^3 = 2991.0; the first nine cover only the
/// right half.
json layers() {
    json all = json::array();
    for (int i = 0; i < 30; ++i)
        all.push_back({{"rect", {i < 9 ? 0.5 : 0.0, 0, 1, 1}}, {"depth", 0.001}, {"color", {0, 1, 0}}, {"alpha", 1}});
    return {{"type", "layers"}, {"layers", all}};
}

json findings_of(gl::Context& context, const Spec& spec) {
    NoAssets assets;
    const Scene scene(context.gl(), build_geometry(spec.scene, spec.image, assets), spec.scene);
    const Target target(context.gl(), spec.image, spec.image.format);
    gl::FrameTimer timer(context);
    const auto method =
        find_method(spec.methods[0].id)->make({context, context.gl(), scene, target}, spec.methods[0].parameters);
    const gl::FrameTimer::Frame frame = timer.frame(false);
    return method->findings(timer)["sums"];
}

/// 21 layers sum to 62,811, 30 to 89,730, which is more than the 65,504 that 16 bits hold. Devices differ in whether
/// they round that to infinity.
TEST(Wboit, SaysWhereItsSumsOverflow) {
    const auto context = make_context("egl");
    const Spec spec = make_spec(layers(), {"wboit"}, 4);
    const json overflowed = findings_of(*context, spec);
    EXPECT_EQ(overflowed["overflowed_pixels"], 8) << "the right half";
    EXPECT_NEAR(overflowed["greatest"].get<double>(), 21 * 2991.0, 22 * 0x1p-10 * 62811);
}

TEST(Wboit, DoesNotOverflowWithLowerWeightsOrIn32Bits) {
    const auto context = make_context("egl");
    const Spec lower = make_spec(layers(), {{{"id", "wboit"}, {"greatest_weight", 1000}}}, 4);
    EXPECT_EQ(findings_of(*context, lower)["overflowed_pixels"], 0);
    EXPECT_NEAR(findings_of(*context, lower)["greatest"].get<double>(), 30000, 30 * 0x1p-10 * 30000);
    const Spec floats = make_spec(layers(), {"wboit"}, 4, "rgba32f");
    EXPECT_EQ(findings_of(*context, floats)["overflowed_pixels"], 0);
    EXPECT_NEAR(findings_of(*context, floats)["greatest"].get<double>(), 30 * 3000 * 0.997002999, 0.1);
    Stage stage(*context, lower, lower.image.format);
    EXPECT_EQ(stage.picture(lower.methods[0]).pixel(3, 0)[1], 1.0f);
}

}  // namespace

}  // namespace sheer::test::wboit_test
