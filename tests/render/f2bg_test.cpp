// The walk of a pixel covers what the rasterizer covers, shades it alike, and does not lose the rest of a long list.
#include <glm/gtc/matrix_transform.hpp>

#include "tests/render/render_test.h"
#include "tests/render/sample_count.h"

namespace sheer::test::f2bg_test {

namespace {

using nlohmann::json;

const json walk = {{"id", "f2bg"}, {"threshold", 0}, {"first_batch", 100}};

struct Differences {
    double mean = 0;
    double share = 0;  ///< of pixels that differ by more than a hundredth
};

Differences differences(const Image& a, const Image& b) {
    Differences found;
    const std::size_t pixels = a.rgba.size() / 4;
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        double greatest = 0;
        for (std::size_t i = 4 * pixel; i < 4 * pixel + 3; ++i)
            greatest = std::max(greatest, std::abs(double{a.rgba[i]} - b.rgba[i]));
        found.mean += greatest / static_cast<double>(pixels);
        if (greatest > 1e-2) found.share += 1.0 / static_cast<double>(pixels);
    }
    return found;
}

/// Devices interpolate with less than the precision of 32-bit floats, and llvmpipe has the level of detail of four
/// pixels.
TEST(F2bg, WalksTheFragmentsThatTheRasterizerDraws) {
    const auto context = make_context("egl");
    const json texture = {{"image", "leaf"}, {"size", 64}};
    for (const json& scene :
         {json{{"type", "quads"}, {"count", 150}, {"shading", "4x4-textures"}, {"texture", texture}},
          json{{"type", "quads"}, {"count", 50}, {"shading", "4-textures-math"}, {"texture", texture}},
          json{{"type", "foliage"}}, json{{"type", "particles"}, {"count", 300}},
          json{{"type", "volume"}, {"slices", 16}}}) {
        const Spec spec = make_spec(scene, {"f2b", walk}, 96, "rgba32f");
        Stage stage(*context, spec, PixelFormat::rgba32f);
        const Differences found = differences(stage.picture(spec.methods[0]), stage.picture(spec.methods[1]));
        EXPECT_LT(found.share, 1e-2) << scene;
        EXPECT_LT(found.mean, 4e-4) << scene;
    }
}

/// Rectangles that meet at pixel centers: each pixel belongs to one of them, on llvmpipe to the same as the
/// rasterizer's.
TEST(F2bg, GivesAPixelOnAnEdgeToOneTriangle) {
    const auto context = make_context("egl");
    const double edge = 10.5 / 32;
    json layers = json::array();
    for (const std::array<double, 4>& rect : {std::array{0.0, 0.0, edge, edge}, std::array{edge, 0.0, 1.0, edge},
                                              std::array{0.0, edge, edge, 1.0}, std::array{edge, edge, 1.0, 1.0}})
        layers.push_back({{"depth", 0.3},
                          {"color", {1, rect[0], rect[1]}},
                          {"alpha", 0.5},
                          {"rect", {rect[0], rect[1], rect[2], rect[3]}}});
    const Spec spec = make_spec({{"type", "layers"}, {"layers", layers}}, {"f2b", walk}, 32, "rgba32f");
    Stage stage(*context, spec, PixelFormat::rgba32f);
    const Image drawn = stage.picture(spec.methods[0]), walked = stage.picture(spec.methods[1]);
    if (context->device().software) {
        EXPECT_LT(greatest_difference(drawn, walked), 1e-6);
    }
    // Half of one rectangle's color and half of the background, whichever it is.
    for (int at = 0; at < 32; ++at)
        for (const float blue : {walked.pixel(3, at)[2], walked.pixel(at, 3)[2]})
            EXPECT_TRUE(std::abs(blue - 0.3) < 1e-6 || std::abs(blue - 0.3 - edge / 2) < 1e-6) << at << " " << blue;
}

/// A floor that begins behind the eye, in perspective.
TEST(F2bg, DrawsTrianglesThatReachBehindTheEye) {
    const auto context = make_context("egl");
    const Spec spec = make_spec({{"type", "layers"}, {"layers", json::array({full_layer(0.5, {1, 1, 1}, 0.5)})}},
                                {"f2b", walk}, 64, "rgba32f");
    Geometry floor;
    floor.view_projection = glm::perspectiveRH_ZO(1.2f, 1.0f, 0.1f, 100.0f);
    const glm::vec4 tint{0.9, 0.5, 0.1, 0.5};
    for (const glm::vec2 corner : {glm::vec2(-30, 20), glm::vec2(30, 20), glm::vec2(0, -50)})
        floor.vertices.push_back({glm::vec3(corner.x, -1, corner.y), glm::vec2(0), tint, 0});
    floor.indices = {0, 1, 2};
    floor.primitives.push_back({0, 3, 10, false});
    Stage stage(*context, spec, PixelFormat::rgba32f, floor);
    const Image drawn = stage.picture(spec.methods[0]), walked = stage.picture(spec.methods[1]);
    EXPECT_LT(differences(drawn, walked).share, 2e-3);
    // Half of the background and half of the tint below the horizon, the background alone above it.
    EXPECT_NEAR(walked.pixel(32, 60)[0], 0.5 * 0.2 + 0.5 * 0.9, 1e-5);
    EXPECT_NEAR(walked.pixel(32, 5)[0], 0.2, 1e-6);
}

/// 40 fragments of 3,000 iterations each are more than llvmpipe allows a shader.
TEST(F2bg, StaysBelowTheLimitOfIterations) {
    const auto context = make_context("egl");
    json layers = json::array();
    for (int i = 0; i < 40; ++i) layers.push_back(full_layer(0.1 + 0.02 * i, {1, 1, 1}, 0.05));
    json scene = layers_scene(layers);
    scene["shading"] = {{"glsl",
                         "float sum = 0.0; for (int i = 0; i < 3000; ++i) sum += 0.001; "
                         "return vec4(vec3(sum / 3.0), tint.a);"}};
    const Spec spec = make_spec(scene, json::array({walk}), 8, "rgba32f");
    Stage stage(*context, spec, PixelFormat::rgba32f);
    const double left = std::pow(0.95, 40);
    EXPECT_NEAR(stage.picture(spec.methods[0]).pixel(4, 4)[0], 1 - left + left * 0.2, 1e-3);
}

TEST(F2bg, IsUnsupportedIfTheShadingTakesDerivatives) {
    const auto context = make_context("egl");
    json scene = layers_scene(json::array({full_layer(0.5, {1, 1, 1}, 0.5)}));
    scene["shading"] = {{"glsl", "return vec4(dFdx(uv), 0.0, tint.a);"}};
    const Spec spec = make_spec(scene, json::array({walk}));
    Stage stage(*context, spec, PixelFormat::rgba8);
    EXPECT_THROW(stage.make(spec.methods[0]), Unsupported);
    // What the fragment knows of itself is no such thing.
    scene["shading"] = {{"glsl", "return vec4(gl_FragCoord.z, gl_FrontFacing ? 1.0 : 0.0, 0.0, 1.0);"}};
    const Spec own = make_spec(scene, {walk, "f2b"}, 32, "rgba32f");
    Stage other(*context, own, PixelFormat::rgba32f);
    EXPECT_LT(greatest_difference(other.picture(own.methods[0]), other.picture(own.methods[1])), 1e-6);
}

}  // namespace

}  // namespace sheer::test::f2bg_test
