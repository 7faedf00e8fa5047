// The references are rounded once, in the same way as the methods' target, so that any difference comes from the
// method.
#include <cmath>

#include "renderer/compare/compare.h"
#include "renderer/core/random.h"
#include "renderer/passes/float_opaque.h"
#include "tests/render/formulas.h"
#include "tests/render/render_test.h"

namespace sheer::test::rounding_test {

namespace {

using nlohmann::json;

constexpr int size_px = 16;

const json& exact_methods() {
    static const json all = {{{"id", "exact"}, {"form", "lists"}, {"label", "lists"}},
                             {{"id", "exact"}, {"form", "sorted"}, {"label", "sorted"}},
                             "depth_peeling"};
    return all;
}

sheer::Run run_of(const json& scene, const json& methods, const std::string& format, const json& background) {
    const Spec spec = parse_spec(
        {{"scene", scene},
         {"methods", methods},
         {"image", {{"width", size_px}, {"height", size_px}, {"background", background}, {"format", format}}},
         {"timing", {{"rounds", 1}, {"warmup", 1}}}});
    const auto context = make_context("egl");
    NoAssets assets;
    std::vector<sheer::Run> runs;
    compare(
        spec, *context, assets, [](double, const std::string&) {}, [&](const sheer::Run& run) { runs.push_back(run); });
    return runs.at(0);
}

json layer(double depth, double grey, double alpha, const json& rect = {0, 0, 1, 1}, bool opaque = false) {
    return {{"rect", rect}, {"depth", depth}, {"color", {grey, grey, grey}}, {"alpha", alpha}, {"opaque", opaque}};
}

/// Half of the picture is the background alone, with an opaque rectangle whose grey lies between two levels.
json some_layers() {
    return {{"type", "layers"},
            {"layers",
             {layer(0.2, 0.9, 0.3, {0, 0, 0.5, 0.5}), layer(0.4, 0.1, 0.6, {0.25, 0, 0.5, 1}),
              layer(0.9, 100.5 / 255, 1, {0.5, 0.5, 1, 1}, true), layer(0.6, 0.5, 0.5, {0.75, 0.75, 1, 1})}}};
}

TEST(Rounding, ExactIsIdenticalToTheReferenceOverEveryBackground) {
    for (const std::string format : {"rgba8", "rgba16f", "rgba32f"})
        for (int tenth = 0; tenth <= 10; ++tenth) {
            const double grey = tenth / 10.0;
            const sheer::Run run = run_of(some_layers(), exact_methods(), format, {grey, grey, grey});
            for (const MethodResult& result : run.results) {
                const json& values = result.metrics->values;
                EXPECT_EQ(values["differing_pixels"], 0) << format << grey << result.method.label;
                EXPECT_EQ(values["rmse"], 0.0) << format << grey << result.method.label;
                EXPECT_EQ(values["flip"]["mean"], 0.0) << format << grey << result.method.label;
            }
        }
}

/// Where nothing is transparent, every method shows the opaque picture, and so does the reference.
TEST(Rounding, ASkyAloneIsNoDifference) {
    const json scene = {
        {"type", "layers"},
        {"layers", {layer(0.5, 1, 1, {0, 0, 1.0 / 16, 1.0 / 16}), layer(0.6, 0.3, 1, {0, 0, 0.5, 0.5}, true)}}};
    for (const std::string format : {"rgba8", "rgba16f"})
        for (const double grey : {0.1, 0.3, 0.5, 0.7, 0.9, 254.5 / 255}) {
            const sheer::Run run = run_of(scene, {"b2f", "f2b", "alpha_test"}, format, {grey, grey, grey});
            for (const MethodResult& result : run.results)
                EXPECT_EQ(result.metrics->values["differing_pixels"], 0) << format << grey << result.method.label;
        }
}

/// One rounding: half a level, whatever the number of layers. Only the last one counts, so half a level and float noise
/// remain.
TEST(Rounding, IsHalfALevelOfAnyNumberOfLayers) {
    for (const std::size_t count : {1, 8, 64}) {
        Random random(count);
        json layers = json::array();
        for (std::size_t i = 0; i < count; ++i) {
            const double x = static_cast<double>(random.below(8)) / size_px;
            json one =
                layer(random.between(0.05, 0.95), 0, random.unit() * (count > 8 ? 0.2 : 0.9), {x, 0, x + 0.5, 1});
            one["color"] = {random.unit(), random.unit(), random.unit()};
            layers.push_back(one);
        }
        for (const double grey : {0.9822, 0.1, 0.7}) {
            const Spec spec = parse_spec(
                {{"scene", {{"type", "layers"}, {"layers", layers}}},
                 {"methods", exact_methods()},
                 {"image",
                  {{"width", size_px}, {"height", size_px}, {"background", {grey, grey, grey}}, {"format", "rgba8"}}}});
            const Compositor compositor(spec.scene, size_px, {grey, grey, grey});
            const auto context = make_context("egl");
            Stage stage(*context, spec, PixelFormat::rgba8);
            for (const MethodSpec& method : spec.methods) {
                const Image image = stage.picture(method);
                double greatest = 0;
                for (int y = 0; y < size_px; ++y)
                    for (int x = 0; x < size_px; ++x)
                        for (int c = 0; c < 3; ++c)
                            greatest = std::max(greatest, std::abs(compositor.pixel(x, y, over_by_depth)[c] -
                                                                   double{image.pixel(x, y)[c]}));
                // GPUs may be off by a tenth of a level more when they convert a float.
                EXPECT_LE(greatest * 255, context->device().software ? 0.501 : 0.6)
                    << method.label << count << ' ' << grey;
            }
        }
    }
}

/// The row of the format: only the cost of rounding the reference. 0.7 is 178.5 levels, and 0.3 is 76.5.
TEST(Rounding, TellsWhatTheFormatAloneCosts) {
    const json scene = {{"type", "layers"}, {"layers", {layer(0.5, 1, 1, {0, 0, 0.5, 1})}}};
    const sheer::Run eight = run_of(scene, {"b2f"}, "rgba8", {0.7, 0.7, 0.7});
    const sheer::Run half = run_of(scene, {"b2f"}, "rgba16f", {0.7, 0.7, 0.7});
    const sheer::Run full = run_of(scene, {"b2f"}, "rgba32f", {0.7, 0.7, 0.7});
    EXPECT_NEAR(eight.format_cost->values["linear"]["max_abs"].get<double>(), 0.5 / 255, 1e-6);
    EXPECT_NEAR(eight.format_cost->values["linear"]["rmse"].get<double>(), std::sqrt(0.5) * 0.5 / 255, 1e-6);
    // The half floats next to 0.7 are 1433 and 1434 / 2048; the device decides which one it becomes.
    const double of_half = half.format_cost->values["linear"]["max_abs"];
    EXPECT_NEAR(of_half, of_half < 0.00025 ? 1434.0 / 2048 - 0.7 : 0.7 - 1433.0 / 2048, 1e-6);
    EXPECT_EQ(full.format_cost->values["linear"]["max_abs"], 0.0);
    EXPECT_EQ(full.format_cost->values["over_backgrounds"]["max_abs"], 0.0);
}

TEST(Rounding, RoundsAPictureAsTheDeviceDoes) {
    const auto context = make_context("egl");
    Image picture(3, 2);
    picture.rgba = {0.2f, 100.4f / 255, 1.5f, 1, 0, 1, -2, 1, 3.7f / 255, 3.3f / 255, 127.6f / 255, 1,
                    0.2f, 100.4f / 255, 1.5f, 1, 0, 1, -2, 1, 3.7f / 255, 3.3f / 255, 127.6f / 255, 0};
    const Image eight = rounded_to(PixelFormat::rgba8, context->gl(), picture);
    const std::vector<float> levels = {51, 100, 255, 255, 0, 255, 0, 255, 4, 3, 128, 255};
    for (std::size_t i = 0; i < levels.size(); ++i) EXPECT_NEAR(eight.rgba[i] * 255, levels[i], 1e-4) << i;
    EXPECT_EQ(eight.rgba[23], 0);
    EXPECT_EQ(rounded_to(PixelFormat::rgba32f, context->gl(), picture).rgba, picture.rgba);
}

}  // namespace

}  // namespace sheer::test::rounding_test
