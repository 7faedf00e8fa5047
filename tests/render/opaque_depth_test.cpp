// What the marks of opaque fragments stop, and that the picture stays that of F2B.
#include "renderer/core/random.h"
#include "tests/render/sample_count.h"

namespace sheer::test::opaque_depth_test {

namespace {

constexpr int size_px = 16;
constexpr int pixels = size_px * size_px;

nlohmann::json opaque_depth(const std::string& variant, int batch = 0, int depth_bits = 24) {
    return {{"id", "opaque_depth"}, {"variant", variant}, {"batch", batch}, {"depth_bits", depth_bits}};
}

const std::vector<std::string>& variants() {
    static const std::vector<std::string> all = {"shader_depth", "target_alpha", "two_pass"};
    return all;
}

nlohmann::json full_layers(const std::vector<double>& alphas) {
    nlohmann::json layers = nlohmann::json::array();
    for (std::size_t i = 0; i < alphas.size(); ++i)
        layers.push_back(full_layer(0.1 + 0.05 * static_cast<double>(i), {1, 0.5, 0.25}, alphas[i]));
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

/// Every method composites once; two_pass also copies the depth of the opaque pass.
constexpr int composite = 1, depth_copy = 1;

TEST(OpaqueDepth, BlendsUpToTheFirstOpaqueFragment) {
    // 0.5 and 1 are blended, 0 is dropped, the rest is behind an opaque fragment.
    const nlohmann::json scene = full_layers({0.5, 0, 1, 0.5, 1, 0.5});
    EXPECT_EQ(samples_per_pixel(scene, opaque_depth("shader_depth")), 2 + composite);
    EXPECT_EQ(samples_per_pixel(scene, opaque_depth("shader_depth", 0, 16)), 2 + composite);
    EXPECT_EQ(samples_per_pixel(scene, opaque_depth("target_alpha")), 2 + composite);
    // A device may count the fragment with alpha 0 here: its shader asks for early tests before it discards it.
    const nlohmann::json all_seen = full_layers({0.5, 1, 0.5, 1, 0.5});
    EXPECT_EQ(samples_per_pixel(all_seen, opaque_depth("two_pass")), 2 + composite + depth_copy);
}

/// The fourth case of the article, opaque behind opaque: equal marks would let all of them through.
TEST(OpaqueDepth, OpaqueBehindOpaqueIsStopped) {
    const nlohmann::json scene = full_layers({1, 1, 1, 1});
    for (const std::string variant : {"shader_depth", "target_alpha"})
        for (const int bits : {16, 24})
            EXPECT_EQ(samples_per_pixel(scene, opaque_depth(variant, 0, bits)), 1 + composite) << variant << bits;
    EXPECT_EQ(samples_per_pixel(scene, opaque_depth("two_pass")), 1 + composite + depth_copy);
}

/// With static marks each of the four is blended, three of them unnecessarily; other alphas between them change
/// nothing.
TEST(OpaqueDepth, StaticMarksBlendOpaqueBehindOpaqueAgain) {
    for (const std::string variant : {"shader_depth", "target_alpha"})
        for (const int bits : {16, 24, 32}) {
            nlohmann::json method = opaque_depth(variant, 0, bits);
            method["marks"] = "static";
            EXPECT_EQ(samples_per_pixel(full_layers({1, 1, 1, 1}), method), 4 + composite) << variant << bits;
            EXPECT_EQ(samples_per_pixel(full_layers({0.5, 1, 0.5, 1, 0}), method), 3 + composite) << variant << bits;
        }
}

TEST(OpaqueDepth, FindingsCountWhatIsBlendedAgain) {
    const auto context = make_context("egl");
    const auto blended_again = [&](const std::string& variant, const std::string& marks, int batch) {
        nlohmann::json method = opaque_depth(variant, batch);
        method["marks"] = marks;
        const Spec spec = make_spec(full_layers({0.5, 1, 0.5, 1, 1, 0.25}), nlohmann::json::array({method}), size_px);
        Stage stage(*context, spec, PixelFormat::rgba8);
        const auto made = stage.make(spec.methods[0]);
        stage.frame(*made);
        const Image before = stage.target().read();
        gl::FrameTimer timer(*context);
        gl::FrameTimer::Frame frame = timer.frame(false);
        const nlohmann::json found = made->findings(timer);
        frame.end();
        stage.frame(*made);
        EXPECT_EQ(greatest_difference(before, stage.target().read()), 0);
        return found;
    };
    // Two opaque fragments lie behind the first one.
    EXPECT_EQ(blended_again("shader_depth", "static", 0)["blended_again"], 2 * pixels);
    EXPECT_EQ(blended_again("target_alpha", "static", 0)["blended_again"], 2 * pixels);
    // Batches of four: the second of the two is stopped by the merge.
    EXPECT_EQ(blended_again("shader_depth", "static", 4)["blended_again"], pixels);
    EXPECT_EQ(blended_again("shader_depth", "incremental", 0), nlohmann::json::object());
    EXPECT_EQ(blended_again("two_pass", "static", 0), nlohmann::json::object());
}

/// The pass draws every pixel, marked or not; an alpha test draws those that it marks.
TEST(OpaqueDepth, MarksByAShaderInsteadOfAClear) {
    nlohmann::json method = opaque_depth("target_alpha", 1);
    const nlohmann::json scene = full_layers({0.5, 0, 1, 0.5, 1, 0.5});
    EXPECT_EQ(samples_per_pixel(scene, method), 2 + 3 + composite);
    method["mark_pass"] = "shader";
    EXPECT_EQ(samples_per_pixel(scene, method), 2 + 5 + composite);
}

/// A merge is one sample if the pixel is still open, none if its depth or stencil is set. Six batches of one:
/// five merges, of which the first two find the pixel open.
TEST(OpaqueDepth, MergesKeepThePixelClosed) {
    const nlohmann::json scene = full_layers({0.5, 0, 1, 0.5, 1, 0.5});
    EXPECT_EQ(samples_per_pixel(scene, opaque_depth("shader_depth", 1)), 2 + 2 + composite);
    // Batches of two: {0.5, 0}, {1, 0.5}, {1, 0.5}; the first merge finds it open.
    EXPECT_EQ(samples_per_pixel(scene, opaque_depth("shader_depth", 2)), 2 + 1 + composite);
    // With marks from the target's alpha it is the other way round: a sample if the pixel is closed, as in the last
    // three merges.
    EXPECT_EQ(samples_per_pixel(scene, opaque_depth("target_alpha", 1)), 2 + 3 + composite);
}

/// Alpha 0.9 leaves 26, 3 and 0 of 255: only target_alpha sees it, and marks it before each of the seven batches left.
TEST(OpaqueDepth, OnlyTargetAlphaSeesAccumulatedOpacity) {
    const nlohmann::json scene = full_layers(std::vector<double>(10, 0.9));
    EXPECT_EQ(samples_per_pixel(scene, opaque_depth("target_alpha", 1)), 3 + 7 + composite);
    EXPECT_EQ(samples_per_pixel(scene, opaque_depth("shader_depth", 1)), 10 + 9 + composite);
    EXPECT_EQ(samples_per_pixel(scene, opaque_depth("two_pass", 1)), 10 + composite + depth_copy);
}

/// 16 bits distinguish 32,768 triangles, so 40,000 rectangles of two need three batches; 24 bits need one. No fragment
/// is opaque, so each of the two merges counts once per pixel.
TEST(OpaqueDepth, DepthBitsBoundTheBatch) {
    const auto context = make_context("egl");
    const nlohmann::json quads = {{"type", "quads"}, {"count", 40000}, {"shading", "constant"}};
    const nlohmann::json methods = {opaque_depth("shader_depth", 0, 16), opaque_depth("shader_depth", 0, 24)};
    const Spec spec = make_spec(quads, methods, 2, "rgba32f");
    Stage stage(*context, spec, PixelFormat::rgba32f);
    const auto narrow = stage.make(spec.methods[0]), wide = stage.make(spec.methods[1]);
    const auto difference = samples_of_frame(*context, stage, *narrow) - samples_of_frame(*context, stage, *wide);
    EXPECT_EQ(difference, 2 * 2 * 2);
}

nlohmann::json random_layers(std::uint64_t seed) {
    Random random(seed);
    nlohmann::json layers = nlohmann::json::array();
    for (int i = 0; i < 40; ++i) {
        const double x = static_cast<double>(random.below(10)) / size_px,
                     y = static_cast<double>(random.below(10)) / size_px;
        const std::array alphas = {0.0, 1.0, random.unit(), random.unit()};
        layers.push_back({{"rect", {x, y, x + 0.5, y + 0.5}},
                          {"depth", random.between(0.05, 0.95)},
                          {"color", {random.unit(), random.unit(), random.unit()}},
                          {"alpha", alphas[random.below(4)]},
                          {"opaque", i % 13 == 5}});
    }
    return layers_scene(layers);
}

/// Batches of 1, 3 and all, so that marks are merged in the middle of everything.
TEST(OpaqueDepth, PictureIsThatOfF2b) {
    nlohmann::json methods = {"f2b"};
    for (const std::string& variant : variants())
        for (const int batch : {0, 1, 3})
            for (const int bits : {16, 24, 32}) {
                methods.push_back(opaque_depth(variant, batch, bits));
                methods.push_back(opaque_depth(variant, batch, bits));
                methods.back()["marks"] = "static";
                methods.back()["mark_pass"] = "shader";
            }
    const nlohmann::json leaves = {
        {"type", "quads"}, {"count", 60}, {"shading", "1-texture"}, {"texture", {{"image", "leaf"}, {"size", 64}}}};
    const auto context = make_context("egl");
    for (const nlohmann::json& scene : {random_layers(1), random_layers(2), leaves})
        for (const std::string format : {"rgba8", "rgba16f", "rgba32f"}) {
            const Spec spec = make_spec(scene, methods, size_px, format);
            Stage stage(*context, spec, spec.image.format);
            const Image expected = stage.picture(spec.methods[0]);
            // What is left out is less than half a level, or 1e-6 of the light, in each layer.
            const double tolerance = format == "rgba8" ? 1.0 / 255 : format == "rgba16f" ? 0x1p-10 : 1e-5;
            for (const MethodSpec& method : spec.methods)
                EXPECT_LE(greatest_difference(expected, stage.picture(method)), tolerance)
                    << format << ' ' << method.parameters;
        }
}

/// Worked out by hand, in one pixel: 0.5 of red in front of an opaque green fragment, in front of white, which must be
/// hidden. An opaque object between green and white changes nothing; in front of green it hides it.
TEST(OpaqueDepth, OpaqueGeometryByHand) {
    const auto context = make_context("egl");
    for (const std::string& variant : variants())
        for (const double depth : {0.5, 0.3}) {
            const nlohmann::json layers = {full_layer(0.6, {1, 1, 1}, 0.9), full_layer(0.4, {0, 1, 0}, 1),
                                           full_layer(0.2, {1, 0, 0}, 0.5), full_layer(depth, {0, 0, 1}, 1, true)};
            const Spec spec =
                make_spec(layers_scene(layers), nlohmann::json::array({opaque_depth(variant, 1)}), 4, "rgba32f");
            Stage stage(*context, spec, PixelFormat::rgba32f);
            const auto method = stage.make(spec.methods[0]);
            const std::array expected = depth == 0.5 ? std::array{0.5, 0.5, 0.0} : std::array{0.5, 0.0, 0.5};
            for (int frame = 0; frame < 2; ++frame) {
                stage.frame(*method);
                const Image image = stage.target().read();
                for (int i = 0; i < 3; ++i)
                    EXPECT_NEAR(image.pixel(1, 2)[i], expected[i], 1e-6) << variant << depth << frame;
            }
        }
}

TEST(OpaqueDepth, SaysWhatItTakes) {
    const auto context = make_context("egl");
    const nlohmann::json methods = {opaque_depth("shader_depth"), opaque_depth("target_alpha", 0, 16),
                                    opaque_depth("two_pass"), opaque_depth("shader_depth", 0, 32),
                                    opaque_depth("target_alpha", 0, 32)};
    const Spec spec = make_spec(full_layers({0.5}), methods, size_px);
    Stage stage(*context, spec, PixelFormat::rgba8);
    EXPECT_EQ(stage.make(spec.methods[0])->memory_bytes(), pixels * (4 + 4));
    EXPECT_EQ(stage.make(spec.methods[1])->memory_bytes(), pixels * (4 + 2));
    EXPECT_EQ(stage.make(spec.methods[2])->memory_bytes(), pixels * (4 + 8));
    EXPECT_EQ(stage.make(spec.methods[3])->memory_bytes(), pixels * (4 + 8));
    EXPECT_EQ(stage.make(spec.methods[4])->memory_bytes(), pixels * (4 + 4));
    EXPECT_THROW(make_spec(full_layers({0.5}), nlohmann::json::array({opaque_depth("shader_depth", 0, 20)})),
                 SpecError);
}

}  // namespace

}  // namespace sheer::test::opaque_depth_test
