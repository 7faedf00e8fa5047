// Pictures over backgrounds other than the spec's: which errors in a method's alpha they reveal.
#include <gmock/gmock.h>

#include "renderer/compare/compare.h"
#include "tests/render/render_test.h"

namespace sheer::test::backgrounds_test {

namespace {

using nlohmann::json;

json layer(double depth, double grey, double alpha, bool opaque = false, const json& rect = {0, 0, 1, 1}) {
    return {{"rect", rect}, {"depth", depth}, {"color", {grey, grey, grey}}, {"alpha", alpha}, {"opaque", opaque}};
}

json scene(const json& layers) {
    return {{"type", "layers"}, {"layers", layers}};
}

sheer::Run run_of(const json& layers, const json& methods, const std::string& format,
                  const json& background = {0, 0, 0}) {
    const Spec spec =
        parse_spec({{"scene", scene(layers)},
                    {"methods", methods},
                    {"image", {{"width", 32}, {"height", 16}, {"background", background}, {"format", format}}},
                    {"timing", {{"rounds", 1}}}});
    const auto context = make_context("egl");
    NoAssets assets;
    std::vector<sheer::Run> runs;
    compare(
        spec, *context, assets, [](double, const std::string&) {}, [&](const sheer::Run& run) { runs.push_back(run); });
    return runs.at(0);
}

/// After the nearer layer 0.25 of the light is left, under the threshold; the farther one is black, so over black it
/// makes no difference that f2bd leaves it out. The transmittance should be 0.125 and is 0.25 with f2bd.
TEST(Backgrounds, ALayerLeftOutShowsOverWhiteOnly) {
    const sheer::Run run = run_of({layer(0.7, 0, 0.5), layer(0.3, 0.5, 0.75)},
                                  {"b2f", {{"id", "f2bd"}, {"threshold", 0.5}, {"batch", 1}}}, "rgba32f");
    const json exact = run.results[0].metrics->values, early = run.results[1].metrics->values;
    EXPECT_EQ(early["rmse"], 0.0) << "the spec's background is black";
    EXPECT_EQ(early["linear"]["rmse"], 0.0);
    EXPECT_EQ(early["over_backgrounds"]["black"], 0.0);
    EXPECT_NEAR(early["over_backgrounds"]["white"].get<double>(), 0.125, 1e-6);
    // Four squares a row, two rows: half of the pixels are on white.
    EXPECT_NEAR(early["over_backgrounds"]["checker"].get<double>(), 0.125 * std::sqrt(0.5), 1e-6);
    EXPECT_EQ(early["over_backgrounds"]["worst"], "white");
    EXPECT_LT(exact["over_backgrounds"]["rmse"], 1e-6);
}

/// Opaque geometry hides any background: the right half of the picture has no error.
TEST(Backgrounds, AreHiddenByOpaqueGeometry) {
    const sheer::Run run = run_of(
        {layer(0.8, 0.5, 1, true, {0.5, 0, 1, 1}), layer(0.7, 0, 0.5, false, {0, 0, 0.5, 1}), layer(0.3, 0.5, 0.75)},
        {{{"id", "f2bd"}, {"threshold", 0.5}, {"batch", 1}}}, "rgba32f");
    const json found = run.results[0].metrics->values["over_backgrounds"];
    EXPECT_NEAR(found["white"].get<double>(), 0.125 * std::sqrt(0.5), 1e-6);
    EXPECT_EQ(found["black"], 0.0);
}

/// The picture of the report stays that of the spec's background.
TEST(Backgrounds, LeaveTheReportsPicturesAlone) {
    const sheer::Run run = run_of(json::array({layer(0.3, 0, 0.5)}), {"f2b", "stencil_cap"}, "rgba32f", {0.25, 0.5, 1});
    for (const Image* image : {&run.reference_image, &run.results[0].image, &run.results[1].image}) {
        EXPECT_NEAR(image->pixel(3, 3)[0], 0.125, 1e-6);
        EXPECT_NEAR(image->pixel(3, 3)[1], 0.25, 1e-6);
        EXPECT_NEAR(image->pixel(3, 3)[2], 0.5, 1e-6);
    }
    EXPECT_LT(*run.residual, 1e-6) << "depth peeling has the same background";
}

/// In 8 bits a grey of 0.5 is 128/255, and so is the float picture: its error is that of the levels.
TEST(Backgrounds, OfEightBitsAreRounded) {
    const sheer::Run run = run_of(json::array({layer(0.3, 1, 0.5)}), {"f2b"}, "rgba8");
    const json found = run.results[0].metrics->values;
    EXPECT_EQ(found["rmse"], 0.0);
    EXPECT_NEAR(found["linear"]["max_abs"].get<double>(), 128 / 255.0 - 0.5, 1e-6);
}

/// What a method keeps from frame to frame must not affect another background: a restarted method equals a new one.
TEST(Backgrounds, RestartedMethodsAreAsNew) {
    const auto context = make_context("egl");
    const json layers = {layer(0.9, 0.2, 1, true, {0, 0, 0.4, 0.6}), layer(0.7, 0.9, 0.4),
                         layer(0.5, 0.1, 0.6, false, {0, 0, 0.9, 1}), layer(0.3, 0.6, 0.3, false, {0.2, 0.3, 1, 1})};
    json methods = json::array({{{"id", "stencil_cap"}, {"layers", 1}, {"frames", 3}}});
    for (const MethodInfo& method : all_methods()) methods.push_back(method.id);
    const Spec spec = make_spec(scene(layers), methods, 16, "rgba32f");
    NoAssets assets;
    const Scene drawn(context->gl(), build_geometry(spec.scene, spec.image, assets), spec.scene);
    Target target(context->gl(), spec.image, PixelFormat::rgba32f);
    gl::FrameTimer timer(*context);
    const auto frame = [&](Method& method) {
        gl::FrameTimer::Frame drawn_frame = timer.frame(false);
        method.render(timer);
        drawn_frame.end();
        return target.read();
    };
    for (const MethodSpec& method : spec.methods) {
        SCOPED_TRACE(method.label);
        const auto make = [&] {
            return find_method(method.id)->make({*context, context->gl(), drawn, target}, method.parameters);
        };
        std::unique_ptr<Method> used;
        try {
            used = make();
        } catch (const Unsupported&) {
            continue;
        }
        target.set_background(spec.image.background);
        const Image before = frame(*used);
        target.set_background({1, 1, 1});
        used->restart();
        const Image again = frame(*used);
        if (find_method(method.id)->no_metrics_reason.empty()) {
            EXPECT_GT(greatest_difference(before, again), 0.01) << "the background shows";
        }
        EXPECT_EQ(greatest_difference(again, frame(*make())), 0);
    }
}

}  // namespace

}  // namespace sheer::test::backgrounds_test
