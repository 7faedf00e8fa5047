// An alpha equal to the reference counts as at least the reference, all over a surface, however it is oriented.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/render/render_test.h"

namespace sheer::test::alpha_reference_test {

namespace {

using nlohmann::json;

constexpr int size_px = 64;

/// Oblique planes that extend far beyond the picture and its corners, so that interpolated values are rounded; all of
/// one tint, red.
Geometry oblique_planes(float alpha) {
    Geometry geometry;
    for (int i = 0; i < 12; ++i) geometry.add_rect(0, 0, 1, 1, 0.5f, {1, 0, 0, alpha}, false);
    const glm::mat4 clip_to_zero_one = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 0.5f, 0}, {0, 0, 0.5f, 1}};
    geometry.view_projection = clip_to_zero_one * glm::perspective(glm::radians(70.0f), 1.0f, 0.1f, 900.0f) *
                               glm::lookAt(glm::vec3(0.3f, 1.7f, 4), glm::vec3(0), glm::vec3(0, 1, 0));
    for (std::size_t i = 0; i < geometry.vertices.size(); ++i) {
        const auto plane = static_cast<float>(i / 4);
        const glm::mat4 turn = glm::rotate(glm::mat4(1), 0.37f * plane + 0.11f, glm::vec3(1, 0.3f * plane, 0.2f));
        const glm::vec3 corner = geometry.vertices[i].position;
        geometry.vertices[i].position = turn * glm::vec4(70.0f * corner.x, 90.0f * corner.y, 0.1f * plane, 1);
    }
    return geometry;
}

class AlphaReference : public testing::Test {
  protected:
    /// How many pixels are red; the background has no red.
    int red_pixels(const Geometry& geometry, const json& method, const json& shading = "constant") {
        const Spec spec = parse_spec(
            {{"scene",
              {{"type", "foliage"},
               {"trees", 1},
               {"planes_per_tree", 1},
               {"shading", shading},
               {"texture", {{"image", "leaf"}, {"size", 8}}}}},
             {"methods", json::array({method})},
             {"image", {{"width", size_px}, {"height", size_px}, {"background", {0, 0, 0}}, {"format", "rgba32f"}}}});
        Stage stage(*m_context, spec, PixelFormat::rgba32f, geometry);
        const Image image = stage.picture(spec.methods[0]);
        int count = 0;
        for (std::size_t i = 0; i < image.rgba.size(); i += 4) count += image.rgba[i] > 0 ? 1 : 0;
        return count;
    }

    const std::unique_ptr<gl::Context> m_context = make_context("egl");
};

/// A method that compares alpha with `reference`; a fragment that passes is red.
json compared(const std::string& id, double reference) {
    if (id == "alpha_test") return {{"id", id}, {"reference", reference}};
    if (id == "alpha_to_coverage") return {{"id", id}, {"reference", reference}};
    if (id == "ssam") return {{"id", id}, {"alpha_reference", reference}};
    return {{"id", "stencil_cap"}, {"min_alpha", reference}, {"frames", 1}, {"zcull", id == "stencil_cap with zcull"}};
}

const std::vector<std::string>& comparing_methods() {
    static const std::vector<std::string> all = {"alpha_test", "alpha_to_coverage", "ssam", "stencil_cap",
                                                 "stencil_cap with zcull"};
    return all;
}

TEST_F(AlphaReference, EqualIsEnoughAndJustBelowIsNot) {
    for (const std::string& method : comparing_methods()) {
        const int all = red_pixels(oblique_planes(1), compared(method, 0));
        ASSERT_GT(all, size_px * size_px / 3) << method;
        for (const double reference : {0.5, 64 / 255.0, 128 / 255.0, 1 / 3.0, 0.02, 0.9, 1.0}) {
            const auto alpha = static_cast<float>(reference);
            // By a GPU's own rule so small an alpha may cover no sample.
            if (method == "alpha_to_coverage" && reference < 0.25 && !m_context->device().software) continue;
            EXPECT_EQ(red_pixels(oblique_planes(alpha), compared(method, reference)), all) << method << reference;
            const float less = std::nextafter(alpha, 0.0f);
            EXPECT_EQ(red_pixels(oblique_planes(less), compared(method, reference)), 0) << method << reference;
        }
    }
}

/// At reference 0 nothing is dropped; fragments of alpha 0 are black only if the method weights by alpha.
TEST_F(AlphaReference, ZeroDropsNothing) {
    const int all = red_pixels(oblique_planes(1), compared("alpha_test", 0));
    EXPECT_EQ(red_pixels(oblique_planes(0), compared("alpha_test", 0)), all);
    EXPECT_EQ(red_pixels(oblique_planes(0), compared("alpha_test", 1e-6)), 0);
    EXPECT_EQ(red_pixels(oblique_planes(0.004f), compared("stencil_cap", 0)), all);
}

/// Read from a texture with one alpha, in 8 bits and in half floats, which round it; an 8-bit level less does not pass.
TEST_F(AlphaReference, TexturesOfOneAlphaAreDrawnWhole) {
    const auto textured = [](float alpha, bool eight_bit) {
        Geometry geometry = oblique_planes(1);
        Picture picture{Image(8, 8), eight_bit, {}};
        for (std::size_t i = 0; i < picture.image.rgba.size(); ++i)
            picture.image.rgba[i] = i % 4 == 3 ? alpha : i % 4 == 0 ? 1.0f : 0.0f;
        geometry.textures = {{{"leaf", 8}, picture}};  // instead of the texture that the scene names
        return geometry;
    };
    for (const std::string method : {"alpha_test", "ssam", "stencil_cap", "alpha_to_coverage"})
        for (const bool eight_bit : {true, false}) {
            const int all = red_pixels(textured(1, eight_bit), compared(method, 0), "1-texture");
            for (const int level : {64, 127, 128, 200, 255}) {
                const double reference = level / 255.0;
                EXPECT_EQ(red_pixels(textured(static_cast<float>(reference), eight_bit), compared(method, reference),
                                     "1-texture"),
                          all)
                    << method << level;
                EXPECT_EQ(red_pixels(textured(static_cast<float>((level - 1) / 255.0), eight_bit),
                                     compared(method, reference), "1-texture"),
                          0)
                    << method << level;
            }
        }
}

/// Sprites and leaves as in their scenes, each with its own camera: all of one alpha, from the tints or the texture,
/// and without the ground and the wood that hide some of them.
class SceneAlphaReference : public AlphaReference, public testing::WithParamInterface<const char*> {
  protected:
    Geometry surfaces(float tint_alpha, float texture_alpha) const {
        const Spec spec = make_spec({{"type", GetParam()}}, {"b2f"}, size_px);
        NoAssets none;
        Geometry geometry = build_geometry(spec.scene, spec.image, none);
        std::erase_if(geometry.primitives, [](const Primitive& primitive) { return primitive.opaque; });
        for (Vertex& vertex : geometry.vertices) vertex.tint = {1, 0, 0, tint_alpha};
        Picture picture{Image(8, 8), true, {}};
        for (std::size_t i = 0; i < picture.image.rgba.size(); ++i)
            picture.image.rgba[i] = i % 4 == 3 ? texture_alpha : 1.0f;
        geometry.textures = {{{"leaf", 8}, picture}};  // instead of the texture that the spec names
        return geometry;
    }
};

/// If all fragments have one alpha, a reference equal to it keeps what a reference of 0 keeps; at an edge,
/// `alpha_to_coverage` fills fewer pixels the lower alpha is, whatever the reference.
TEST_P(SceneAlphaReference, EqualIsEnoughAndJustBelowIsNot) {
    for (const std::string& method : comparing_methods()) {
        for (const double reference : {0.5, 128 / 255.0, 1 / 3.0, 1.0}) {
            const auto alpha = static_cast<float>(reference);
            const int all = red_pixels(surfaces(alpha, 1), compared(method, 0));
            ASSERT_GT(all, size_px * size_px / 10) << method << reference;
            EXPECT_EQ(red_pixels(surfaces(alpha, 1), compared(method, reference)), all) << method << reference;
            EXPECT_EQ(red_pixels(surfaces(std::nextafter(alpha, 0.0f), 1), compared(method, reference)), 0)
                << method << reference;
        }
        for (const int level : {64, 128, 255}) {
            const json equal = compared(method, level / 255.0);
            const Geometry of_level = surfaces(1, static_cast<float>(level / 255.0));
            EXPECT_EQ(red_pixels(of_level, equal, "1-texture"), red_pixels(of_level, compared(method, 0), "1-texture"))
                << method << level;
            EXPECT_EQ(red_pixels(surfaces(1, static_cast<float>((level - 1) / 255.0)), equal, "1-texture"), 0)
                << method << level;
        }
    }
}

TEST_P(SceneAlphaReference, ZeroDropsNothing) {
    const int all = red_pixels(surfaces(1, 1), compared("alpha_test", 0));
    EXPECT_EQ(red_pixels(surfaces(0, 1), compared("alpha_test", 0)), all);
    EXPECT_EQ(red_pixels(surfaces(0, 1), compared("alpha_test", 1e-6)), 0);
    EXPECT_EQ(red_pixels(surfaces(1, 0), compared("alpha_test", 0), "1-texture"), all);
    EXPECT_EQ(red_pixels(surfaces(1, 0), compared("alpha_test", 1 / 255.0), "1-texture"), 0);
}

INSTANTIATE_TEST_SUITE_P(Scenes, SceneAlphaReference, testing::Values("particles", "foliage"),
                         [](const auto& scene) { return std::string(scene.param); });

/// Half of the samples if alpha is one half: by llvmpipe's rule anything above it would cover three of four.
TEST_F(AlphaReference, CoverageOfAHalfIsAHalfEverywhere) {
    if (!m_context->device().software) GTEST_SKIP() << "the rule of coverage is the device's own";
    Geometry geometry = oblique_planes(0.5f);
    geometry.primitives.resize(1);
    const Spec spec = make_spec({{"type", "quads"}, {"count", 1}, {"shading", "constant"}},
                                json::array({{{"id", "alpha_to_coverage"}}}), size_px, "rgba32f");
    Stage stage(*m_context, spec, PixelFormat::rgba32f, geometry);
    const Image image = stage.picture(spec.methods[0]);
    int whole = 0;
    for (int y = 1; y + 1 < size_px; ++y)
        for (int x = 1; x + 1 < size_px; ++x) {
            const float red = image.pixel(x, y)[0];
            // Either half of the samples, or fewer at the plane's edge; the background's red is 0.2.
            EXPECT_LE(red, 0.6f + 1e-6f) << x << ' ' << y;
            whole += std::abs(red - 0.6f) < 1e-6f ? 1 : 0;
        }
    EXPECT_GT(whole, size_px);
}

/// Varying values are still interpolated: with alpha from 0 on the left to 1 on the right, half the pixels reach 0.5.
TEST_F(AlphaReference, TintsThatVaryAreInterpolated) {
    Geometry geometry;
    geometry.add_rect(0, 0, 1, 1, 0.5f, {1, 0, 0, 0}, false);
    for (Vertex& vertex : geometry.vertices) vertex.tint.a = vertex.position.x > 0 ? 1 : 0;
    EXPECT_EQ(red_pixels(geometry, compared("alpha_test", 0.5)), size_px * size_px / 2);
}

}  // namespace

}  // namespace sheer::test::alpha_reference_test
