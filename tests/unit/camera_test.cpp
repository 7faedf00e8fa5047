#include "renderer/scene/camera.h"
#include "renderer/spec/spec.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace sheer::camera_test {

namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::IsEmpty;

/// Clip coordinates divided by w.
glm::dvec3 project(const Camera& camera, const Planes& planes, double aspect, const glm::dvec3& point) {
    const glm::dvec4 clip = camera.projection(planes, aspect) * camera.view() * glm::dvec4(point, 1);
    return glm::dvec3(clip) / clip.w;
}

/// From 4 in front of the origin, with a right angle, which sees 4 up and 4 down there.
TEST(Camera, ProjectsByHand) {
    const Camera camera{{0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 90};
    const Planes planes{2, 6};
    const glm::dvec3 point = project(camera, planes, 2, {2, 1, 0});
    EXPECT_NEAR(point.x, 0.25, 1e-12);
    EXPECT_NEAR(point.y, 0.25, 1e-12);
    // depth f (z - n) / (z (f - n)) = 6 * 2 / (4 * 4) at z = 4
    EXPECT_NEAR(point.z, 0.75, 1e-12);
    EXPECT_NEAR(project(camera, planes, 2, {0, 0, 2}).z, 0, 1e-12);
    EXPECT_NEAR(project(camera, planes, 2, {0, 0, -2}).z, 1, 1e-12);
}

TEST(Camera, SeesFromAnySide) {
    // From the right: things in front of the scene are on the left of the picture.
    const Camera camera{{5, 0, 0}, {0, 0, 0}, {0, 1, 0}, 60};
    EXPECT_LT(project(camera, {3, 7}, 1, {0, 0, 1}).x, 0);
    EXPECT_GT(project(camera, {3, 7}, 1, {0, 1, 0}).y, 0);
}

/// A square with half side `size`, facing along z, as an object in the view.
void add_square(Geometry& geometry, const glm::vec3& centre, float size) {
    const auto first = static_cast<std::uint32_t>(geometry.vertices.size());
    for (const glm::vec2 corner : {glm::vec2{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
        geometry.vertices.push_back({centre + glm::vec3(size * corner, 0), {}, {}, 0});
    for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) geometry.indices.push_back(first + i);
    if (geometry.primitives.empty()) geometry.primitives.push_back({});
}

const Camera right_angle{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 90};

Planes planes_of(const Geometry& geometry) {
    return planes_of_view(geometry, right_angle.view(), 90, 1);
}

/// Near objects are not cut off, however far the farthest is; objects beside the view or behind the eye do not count.
TEST(Camera, PlanesEncloseTheVisibleScene) {
    Geometry geometry;
    add_square(geometry, {0, 0, -2}, 1);
    add_square(geometry, {0, 0, -1e5f}, 1000);
    add_square(geometry, {50, 0, -1}, 1);  // beside it
    add_square(geometry, {0, 0, 3}, 100);  // behind
    const Planes planes = planes_of(geometry);
    EXPECT_NEAR(planes.near, 2, 0.001);
    EXPECT_NEAR(planes.far, 1e5, 100);
    EXPECT_LT(planes.near, 2);
    EXPECT_GT(planes.far, 1e5);
}

/// A floor 1 below the eye, from far behind it to 1000 ahead: the lower edge of a right angle meets it at 1.
TEST(Camera, PlanesOfObjectsCutByTheView) {
    Geometry geometry;
    for (const glm::vec3 corner : {glm::vec3{-500, -1, 1000}, {500, -1, 1000}, {0, -1, -1000}})
        geometry.vertices.push_back({corner, {}, {}, 0});
    geometry.indices = {0, 1, 2};
    const Planes planes = planes_of(geometry);
    EXPECT_NEAR(planes.near, 1, 0.001);
    EXPECT_NEAR(planes.far, 1000, 1);
    // A plane through the eye has no nearest point: the near plane stays at a millionth of the far one's distance.
    for (Vertex& vertex : geometry.vertices) vertex.position.y = 0;
    EXPECT_NEAR(planes_of(geometry).near, planes_of(geometry).far * 1e-6, 1e-9);
    EXPECT_LT(planes_of({}).near, planes_of({}).far);
}

/// At Web Mercator coordinates, and in the smallest and largest scenes that floats can represent, distances are the
/// same as near the origin.
TEST(Camera, ProjectionIsTheSameFarAwayAndAtAnyScale) {
    const auto clip = [](const glm::dvec3& origin, float scale) {
        Geometry geometry;
        add_square(geometry, glm::vec3(scale, scale / 2, 0), scale);
        look_through(geometry, {origin + glm::dvec3(0, 0, 5.0 * scale), origin, {0, 1, 0}, 90}, 1, origin);
        const glm::vec4 at = geometry.view_projection * glm::vec4(geometry.vertices[2].position, 1);
        return glm::vec3(at) / at.w;
    };
    const glm::vec3 usual = clip({0, 0, 0}, 1);
    EXPECT_NEAR(usual.x, 0.4, 1e-6);
    EXPECT_NEAR(usual.y, 0.3, 1e-6);
    EXPECT_LT(glm::length(clip({13405321.25, 35.5, -4892765.75}, 1) - usual), 1e-5);
    for (const float scale : {1e-20f, 1e-7f, 1e7f, 1e14f})
        EXPECT_LT(glm::length(clip({0, 0, 0}, scale) - usual), 1e-5) << scale;
}

/// The sphere's outline touches the upper and lower edge of a wide picture, and the left and right of a tall one.
TEST(Camera, FramesASphere) {
    const Sphere bounds{{1, 2, 3}, 1.5};
    for (const double aspect : {0.5, 1.0, 2.0}) {
        SCOPED_TRACE(aspect);
        const Camera camera = read_camera(nullptr, bounds, {0, 0, 1}, aspect);
        const double distance = glm::length(camera.eye - bounds.centre);
        const Planes planes{distance - bounds.radius, distance + bounds.radius};
        const glm::dvec3 middle = project(camera, planes, aspect, bounds.centre);
        EXPECT_NEAR(middle.x, 0, 1e-9);
        EXPECT_NEAR(middle.y, 0, 1e-9);
        double furthest = 0;
        for (int i = 0; i < 3600; ++i) {
            const double angle = i * 2 * 3.14159265358979 / 3600;
            for (const glm::dvec3& axis : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)}) {
                const glm::dvec3 on_sphere =
                    bounds.centre + bounds.radius * (std::cos(angle) * axis + std::sin(angle) * glm::dvec3(0, 0, 1));
                const glm::dvec3 seen = project(camera, planes, aspect, on_sphere);
                furthest = std::max({furthest, std::abs(seen.x), std::abs(seen.y)});
                EXPECT_GE(seen.z, -1e-9);
                EXPECT_LE(seen.z, 1 + 1e-9);
            }
        }
        EXPECT_NEAR(furthest, 1, 1e-5);
    }
}

TEST(Camera, BoundsHoldTheVertices) {
    std::vector<Vertex> vertices(2);
    vertices[0].position = {0, 0, 0};
    vertices[1].position = {2, 4, 4};
    const Sphere sphere = bounding_sphere(vertices);
    EXPECT_EQ(sphere.centre, glm::dvec3(1, 2, 2));
    EXPECT_NEAR(sphere.radius, 3, 1e-12);
}

/// Two quads, 3 and 5 ahead; off the line of sight, the depth counts, not the distance.
TEST(Camera, GivesPrimitivesTheirDepth) {
    Geometry geometry;
    geometry.add_rect(0, 0, 1, 1, 1, glm::vec4(1), false);  // z = 1
    geometry.add_rect(2, 0, 4, 1, -1, glm::vec4(1), false);
    look_through(geometry, {{0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 60}, 1);
    EXPECT_FLOAT_EQ(geometry.primitives[0].depth, 3);
    EXPECT_FLOAT_EQ(geometry.primitives[1].depth, 5);
}

std::vector<std::string> wrong_fields(const json& camera, const std::string& type = "foliage", int count = 1) {
    std::vector<std::string> pointers;
    try {
        parse_spec({{"scene", {{"type", type}, {"camera", camera}, {"seed", count}}}, {"methods", {"b2f"}}});
    } catch (const SpecError& error) {
        for (const FieldError& field : error.errors()) pointers.push_back(field.pointer);
    }
    return pointers;
}

TEST(Camera, DegenerateOnesAreErrors) {
    for (const std::string type : {"foliage", "particles"}) {
        SCOPED_TRACE(type);
        EXPECT_THAT(wrong_fields(nullptr, type), IsEmpty());
        EXPECT_THAT(wrong_fields(json::object(), type), IsEmpty());
        EXPECT_THAT(wrong_fields({{"eye", {1, 2, 3}}, {"target", {1, 2, 3}}}, type),
                    ElementsAre("/scene/camera/target"));
        EXPECT_THAT(wrong_fields({{"eye", {0, 9, 0}}, {"target", {0, 1, 0}}}, type), ElementsAre("/scene/camera/up"));
        EXPECT_THAT(wrong_fields({{"eye", {0, 0, 5}}, {"target", {0, 0, 0}}, {"up", {0, 0, -3}}}, type),
                    ElementsAre("/scene/camera/up"));
        EXPECT_THAT(wrong_fields({{"up", {0, 0, 0}}}, type), ElementsAre("/scene/camera/up"));
    }
}

TEST(Camera, MayBeAnywhere) {
    EXPECT_THAT(wrong_fields({{"eye", {2e7, 5e6, 1e7}}, {"target", {2e7, 5e6, 1e7 - 1}}}), IsEmpty());
    EXPECT_THAT(wrong_fields({{"eye", {0, 0, 1e300}}, {"target", {0, 0, -1e300}}, {"up", {0, 1e-200, 0}}}), IsEmpty());
    for (const double far : {1e9, 1e40, 1e300}) {
        const Spec spec =
            parse_spec({{"scene", {{"type", "particles"}, {"count", 5}, {"camera", {{"eye", {far, far, -far}}}}}},
                        {"methods", {"b2f"}}});
        NoAssets assets;
        const Geometry geometry = build_geometry(spec.scene, spec.image, assets);
        for (int i = 0; i < 16; ++i) EXPECT_TRUE(std::isfinite(geometry.view_projection[i / 4][i % 4])) << far;
    }
}

TEST(Camera, WrongFieldsAreNamedWithTheOthers) {
    EXPECT_THAT(wrong_fields({{"fov_y_deg", 180}}), ElementsAre("/scene/camera/fov_y_deg"));
    EXPECT_THAT(wrong_fields({{"eye", {1, 2}}}), ElementsAre("/scene/camera/eye"));
    EXPECT_THAT(wrong_fields("front"), ElementsAre("/scene/camera"));
    EXPECT_THAT(wrong_fields({{"eye", {0, 9, 0}}, {"target", {0, 1, 0}}}, "foliage", -1),
                testing::UnorderedElementsAre("/scene/seed", "/scene/camera/up"));
    // A wrong eye is replaced by the default: no second error may follow from that.
    EXPECT_THAT(wrong_fields({{"eye", "x"}, {"target", {4, 3, 6}}}), ElementsAre("/scene/camera/eye"));
}

TEST(Camera, IsNullOrCompleteInTheNormalisedSpec) {
    const auto normalised = [](const json& scene) {
        return parse_spec({{"scene", scene}, {"methods", {"b2f"}}}).scene.at("camera");
    };
    EXPECT_EQ(normalised({{"type", "foliage"}}), nullptr);
    EXPECT_EQ(
        normalised({{"type", "foliage"}, {"camera", {{"eye", {0, 1, 9}}}}}),
        json({{"eye", {0.0, 1.0, 9.0}}, {"target", {0.0, 1.5, 0.0}}, {"up", {0.0, 1.0, 0.0}}, {"fov_y_deg", 40.0}}));
}

/// The camera that framed a scene can be written into the spec, and gives the same picture.
TEST(Camera, OfAGeometryGivesTheSamePictureAgain) {
    for (const std::string type : {"foliage", "particles"}) {
        json document = {{"scene", {{"type", type}, {"seed", 3}}}, {"methods", {"b2f"}}};
        NoAssets assets;
        const Spec framed = parse_spec(document);
        const Geometry first = build_geometry(framed.scene, framed.image, assets);
        document["scene"]["camera"] = first.camera;
        const Spec placed = parse_spec(document);
        const Geometry second = build_geometry(placed.scene, placed.image, assets);
        EXPECT_EQ(first.view_projection, second.view_projection) << type;
        EXPECT_EQ(first.vertices[0].position, second.vertices[0].position) << type;
        EXPECT_EQ(first.camera, second.camera) << type;
    }
    const Spec quads = parse_spec({{"scene", {{"type", "quads"}, {"count", 1}}}, {"methods", {"b2f"}}});
    NoAssets assets;
    EXPECT_TRUE(build_geometry(quads.scene, quads.image, assets).camera.is_null());
}

TEST(Camera, IsDescribedAsOptional) {
    const json described = to_json({camera_parameter()}).front();
    EXPECT_EQ(described["kind"], "object");
    EXPECT_EQ(described["optional"], true);
    EXPECT_EQ(described["required"], false);
    EXPECT_EQ(described["default"], nullptr);
    EXPECT_EQ(described["fields"].size(), 4u);
    const json schema = schema_of({camera_parameter()});
    EXPECT_EQ(schema["properties"]["camera"]["type"], json({"object", "null"}));
    EXPECT_FALSE(schema.contains("required"));
}

}  // namespace

}  // namespace sheer::camera_test
