// The scenes with a camera: where points appear, what is hidden, and that every method draws them.
#include "renderer/scene/camera.h"
#include "tests/render/render_test.h"

namespace sheer::test::scenes_3d_test {

namespace {

constexpr int size_px = 64;

nlohmann::json particles(int count) {
    return {{"type", "particles"}, {"count", count}, {"texture", {{"size", 32}}}};
}

nlohmann::json foliage(int planes) {
    return {{"type", "foliage"}, {"trees", 2}, {"planes_per_tree", planes}, {"texture", {{"size", 32}}}};
}

nlohmann::json volume(int slices) {
    return {{"type", "volume"}, {"slices", slices}, {"volume", {{"resolution", 32}}}};
}

/// Small enough for every method.
nlohmann::json scene_of(const std::string& type) {
    if (type == "particles") return particles(60);
    return type == "foliage" ? foliage(30) : volume(50);
}

/// Geometry made by hand, drawn by `b2f` on black.
class Hand {
  public:
    Hand() : m_context(make_context("egl")) {
        m_image.width_px = m_image.height_px = size_px;
        m_image.background = {0, 0, 0};
    }

    /// A square of 0.5 that faces along z.
    void add_square(const glm::vec3& centre, const glm::vec4& tint, bool opaque, const glm::vec2& uv) {
        const auto primitive = static_cast<std::uint32_t>(m_geometry.primitives.size());
        const auto first = static_cast<std::uint32_t>(m_geometry.vertices.size());
        for (const glm::vec2 corner : {glm::vec2{-1, 1}, {1, 1}, {1, -1}, {-1, -1}})
            m_geometry.vertices.push_back({centre + glm::vec3(0.25f * corner, 0), uv, tint, primitive});
        m_geometry.primitives.push_back({static_cast<std::uint32_t>(m_geometry.indices.size()), 6, 0, opaque});
        for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) m_geometry.indices.push_back(first + i);
    }

    /// sheer_distance() of the fragments that are drawn last, in every channel; 0 where there is none.
    Image distances(const std::optional<Camera>& camera) {
        if (camera) look_through(m_geometry, *camera, 1);
        const Scene scene(m_context->gl(), m_geometry, {{"shading", "constant"}, {"texture", {{"size", 16}}}});
        const gl::Program program = scene.make_program(
            "distance",
            "out vec4 o_color;\nvoid main() {\n    begin_fragment();\n    o_color = vec4(sheer_distance());\n}\n");
        const Target target(m_context->gl(), m_image, PixelFormat::rgba32f);
        gl::FrameTimer timer(*m_context);
        gl::FrameTimer::Frame frame = timer.frame(false);
        OpaquePass(m_context->gl(), scene, target).draw(timer);
        Pass pass(m_context->gl(), target);
        scene.draw_transparent(program, sheer::Order::submission);
        frame.end();
        return target.read();
    }

    Image picture(const Camera& camera, const std::string& shading = "constant") {
        look_through(m_geometry, camera, 1);
        const Scene scene(
            m_context->gl(), m_geometry,
            {{"shading", shading}, {"texture", {{"image", "leaf"}, {"size", 16}, {"coverage_alpha", 0}}}});
        const Target target(m_context->gl(), m_image, PixelFormat::rgba32f);
        const auto method =
            find_method("b2f")->make({*m_context, m_context->gl(), scene, target}, nlohmann::json::object());
        gl::FrameTimer timer(*m_context);
        gl::FrameTimer::Frame frame = timer.frame(false);
        method->render(timer);
        frame.end();
        return target.read();
    }

  private:
    std::unique_ptr<gl::Context> m_context;
    ImageSpec m_image;
    Geometry m_geometry;
};

const Camera right_angle{{0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 90};

/// (2, 1, 0) seen from (0, 0, 4) under a right angle lies half right and a quarter up: column 48, row 24 from the top.
TEST(Camera, PointsLieWhereTheyBelong) {
    Hand hand;
    hand.add_square({2, 1, 0}, {1, 0.5f, 0.25f, 1}, false, {0, 0});
    const Image image = hand.picture(right_angle);
    // 0.5 of the 8 that the picture is high there are 4 of its 64 pixels.
    for (int y = 0; y < size_px; ++y)
        for (int x = 0; x < size_px; ++x) {
            const bool inside = x >= 46 && x < 50 && y >= 22 && y < 26;
            EXPECT_EQ(image.pixel(x, y)[0], inside ? 1.0f : 0.0f) << x << ' ' << y;
            EXPECT_EQ(image.pixel(x, y)[1], inside ? 0.5f : 0.0f) << x << ' ' << y;
        }
}

/// Along the camera's axis, so that a square that faces the camera is as far away at its corners as in its middle.
TEST(Camera, DistancesAreThoseAlongItsAxis) {
    Hand hand;
    hand.add_square({0, 0, 1}, {1, 1, 1, 0.5f}, false, {0, 0});
    hand.add_square({2, 1, 0}, {1, 1, 1, 0.5f}, false, {0, 0});
    const Image image = hand.distances(right_angle);
    EXPECT_NEAR(image.pixel(32, 32)[0], 3, 1e-5);
    for (const auto& [x, y] : {std::pair{46, 22}, {49, 25}})
        EXPECT_NEAR(image.pixel(x, y)[0], 4, 1e-5) << x << ' ' << y;
    EXPECT_EQ(image.pixel(0, 0)[0], 0);
}

TEST(Camera, WithoutOneTheDistanceIsTheDepth) {
    Hand hand;
    hand.add_square({0, 0, 0.375f}, {1, 1, 1, 0.5f}, false, {0, 0});
    EXPECT_NEAR(hand.distances(std::nullopt).pixel(32, 32)[0], 0.375, 1e-6);
}

/// The nearer of two opaque squares is visible, whatever their order; one behind the eye is not.
TEST(Camera, NearerOpaqueSquaresHide) {
    for (const bool near_first : {true, false}) {
        Hand hand;
        hand.add_square({0, 0, near_first ? 1.0f : -1.0f}, {near_first, !near_first, 0, 1}, true, untextured_uv);
        hand.add_square({0, 0, near_first ? -1.0f : 1.0f}, {!near_first, near_first, 0, 1}, true, untextured_uv);
        hand.add_square({0, 0, 5}, {0, 0, 1, 1}, true, untextured_uv);
        const Image image = hand.picture(right_angle);
        EXPECT_EQ(image.pixel(32, 32)[0], 1);
        EXPECT_EQ(image.pixel(32, 32)[1], 0);
        EXPECT_EQ(image.pixel(32, 32)[2], 0);
    }
}

/// Near red at half opacity over far green over black, whatever the submission.
TEST(Camera, TransparentSquaresAreDrawnFarToNear) {
    for (const bool near_first : {true, false}) {
        Hand hand;
        hand.add_square({0, 0, near_first ? 1.0f : -1.0f}, {near_first, !near_first, 0, 0.5f}, false, {0, 0});
        hand.add_square({0, 0, near_first ? -1.0f : 1.0f}, {!near_first, near_first, 0, 0.5f}, false, {0, 0});
        const Image image = hand.picture(right_angle);
        EXPECT_EQ(image.pixel(32, 32)[0], 0.5f);
        EXPECT_EQ(image.pixel(32, 32)[1], 0.25f);
    }
}

/// An untextured surface keeps its color under any shading.
TEST(Opaque, UntexturedIsTheTintUnderAnyShading) {
    for (const std::string shading : {"constant", "1-texture", "4x4-textures-math"}) {
        Hand hand;
        hand.add_square({0, 0, 0}, {0.25f, 0.5f, 0.75f, 1}, true, untextured_uv);
        hand.add_square({1, 0, 0}, {0.25f, 0.5f, 0.75f, 1}, true, {0.5f, 0.5f});
        const Image image = hand.picture(right_angle, shading);
        EXPECT_EQ(image.pixel(32, 32)[0], 0.25f) << shading;
        EXPECT_EQ(image.pixel(32, 32)[1], 0.5f) << shading;
        EXPECT_EQ(image.pixel(32, 32)[2], 0.75f) << shading;
        EXPECT_EQ(image.pixel(40, 32)[2] == 0.75f, shading == "constant") << shading;
    }
}

struct Case {
    std::string context, scene;
};

void PrintTo(const Case& test_case, std::ostream* out) {
    *out << test_case.context << ' ' << test_case.scene;
}

class Scenes3d : public testing::TestWithParam<Case> {};

/// Method::picture throws on an error of GL.
TEST_P(Scenes3d, AreDrawnByEveryMethod) {
    const auto context = make_context(GetParam().context);
    nlohmann::json methods = nlohmann::json::array();
    for (const MethodInfo& info : all_methods()) methods.push_back(info.id);
    const Spec spec = make_spec(scene_of(GetParam().scene), methods, size_px);
    Stage stage(*context, spec, spec.image.format);
    for (const MethodSpec& method : spec.methods) {
        SCOPED_TRACE(method.id);
        try {
            const Image image = stage.picture(method);
            std::size_t drawn = 0;
            for (int y = 0; y < size_px; ++y)
                for (int x = 0; x < size_px; ++x) {
                    for (int channel = 0; channel < 3; ++channel)
                        ASSERT_TRUE(std::isfinite(image.pixel(x, y)[channel]));
                    // The blue of the background is 0.6.
                    drawn += std::abs(image.pixel(x, y)[2] - 0.6f) > 0.02f;
                }
            EXPECT_GT(drawn, size_px * size_px / 20);
        } catch (const Unsupported&) {
            // A device may lack something that a method needs; the report says so.
        }
    }
}

/// Two references that share nothing but the scene.
TEST_P(Scenes3d, ReferencesAgree) {
    const auto context = make_context(GetParam().context);
    const Spec spec = make_spec(scene_of(GetParam().scene), {{{"id", "exact"}, {"form", "lists"}}, "depth_peeling"},
                                size_px, "rgba32f");
    Stage stage(*context, spec, PixelFormat::rgba32f);
    EXPECT_LE(greatest_difference(stage.picture(spec.methods[0]), stage.picture(spec.methods[1])), 2e-5);
}

INSTANTIATE_TEST_SUITE_P(All, Scenes3d,
                         testing::Values(Case{"egl", "particles"}, Case{"egl", "foliage"}, Case{"egl", "volume"},
                                         Case{"osmesa", "particles"}, Case{"osmesa", "foliage"},
                                         Case{"osmesa", "volume"}),
                         [](const testing::TestParamInfo<Case>& row) {
                             return row.param.context + "_" + row.param.scene;
                         });

/// Each sprite has one depth, so drawing them in the order of their middles is as good as sorting fragments.
TEST(Particles, SortedPrimitivesAreExact) {
    const auto context = make_context("egl");
    const Spec spec =
        make_spec(particles(800),
                  {{{"id", "exact"}, {"form", "lists"}}, {{"id", "exact"}, {"form", "sorted"}}, "b2f", "unsorted"},
                  size_px, "rgba32f");
    Stage stage(*context, spec, PixelFormat::rgba32f);
    const Image lists = stage.picture(spec.methods[0]);
    EXPECT_LE(greatest_difference(lists, stage.picture(spec.methods[1])), 2e-5);
    EXPECT_LE(greatest_difference(lists, stage.picture(spec.methods[2])), 2e-5);
    EXPECT_GT(greatest_difference(lists, stage.picture(spec.methods[3])), 0.05);
}

/// No order of whole planes is correct where they intersect.
TEST(Foliage, IntersectingPlanesCannotBeSorted) {
    const auto context = make_context("egl");
    const Spec spec = make_spec(foliage(100), {"exact", "b2f"}, size_px, "rgba32f");
    Stage stage(*context, spec, PixelFormat::rgba32f);
    EXPECT_GT(greatest_difference(stage.picture(spec.methods[0]), stage.picture(spec.methods[1])), 0.05);
}

/// From below, only the ground is visible, whatever grows or burns on it.
TEST(Scenes3dOpaque, Hides) {
    const auto context = make_context("egl");
    for (nlohmann::json scene : {particles(300), foliage(60)}) {
        SCOPED_TRACE(scene.dump());
        scene["camera"] = {{"eye", {0, -1.2, 0.01}}, {"target", {0, 0, 0}}, {"fov_y_deg", 50}};
        const Spec spec = make_spec(scene, {"b2f", "exact"}, 16, "rgba32f");
        nlohmann::json sparse = scene;
        sparse[scene["type"] == "particles" ? "count" : "planes_per_tree"] = 1;
        const Spec sparse_spec = make_spec(sparse, {"b2f"}, 16, "rgba32f");
        Stage stage(*context, spec, PixelFormat::rgba32f), sparse_stage(*context, sparse_spec, PixelFormat::rgba32f);
        const Image ground = sparse_stage.picture(sparse_spec.methods[0]);
        for (const MethodSpec& method : spec.methods)
            EXPECT_EQ(greatest_difference(stage.picture(method), ground), 0) << method.id;
        // From above the same scene has more to it.
        scene["camera"]["eye"] = {0, 6, 0.01};
        sparse["camera"]["eye"] = {0, 6, 0.01};
        const Spec above = make_spec(scene, {"b2f"}, 16), above_sparse = make_spec(sparse, {"b2f"}, 16);
        Stage full(*context, above, PixelFormat::rgba8), nearly_bare(*context, above_sparse, PixelFormat::rgba8);
        EXPECT_GT(greatest_difference(full.picture(above.methods[0]), nearly_bare.picture(above_sparse.methods[0])),
                  0.1);
    }
}

}  // namespace

}  // namespace sheer::test::scenes_3d_test
