// The sort for a moved camera: it uploads what Scene would draw.
#include "renderer/scene/depth_sort.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>

#include "renderer/compare/compare.h"
#include "renderer/core/random.h"
#include "tests/render/render_test.h"

namespace sheer::test::depth_sort_test {

namespace {

using testing::ElementsAre;

Geometry layers_at(const std::vector<float>& depths) {
    Geometry geometry;
    for (const float depth : depths) geometry.add_rect(0, 0, 1, 1, depth, {1, 1, 1, 0.5f}, false);
    return geometry;
}

std::vector<std::uint32_t> sorted(const Geometry& geometry, double turn_rad = 0) {
    const auto context = make_context("egl");
    DepthSort sort(context->gl(), geometry);
    sort.sort(turn_rad);
    return sort.order();
}

TEST(DepthSort, IsFarToNearAndKeepsTheOrderOfEquals) {
    EXPECT_THAT(sorted(layers_at({0.25f, 0.75f, 0.5f, 0.75f, 0.25f})), ElementsAre(1, 3, 2, 0, 4));
    EXPECT_THAT(sorted(layers_at({0.5f})), ElementsAre(0));
    EXPECT_THAT(sorted(layers_at({-1.0f, 0.0f, -0.5f, 1e-30f, -1e-30f, 2.0f})), ElementsAre(5, 3, 1, 4, 2, 0));
}

TEST(DepthSort, LeavesOpaquePrimitivesOutAndCopiesWholePrimitives) {
    Geometry geometry = layers_at({0.25f});
    geometry.add_rect(0, 0, 1, 1, 0.9f, {1, 1, 1, 1}, true);
    geometry.add_rect(0, 0, 1, 1, 0.5f, {1, 1, 1, 0.5f}, false);
    const auto context = make_context("egl");
    DepthSort sort(context->gl(), geometry);
    sort.sort(0);
    EXPECT_THAT(sort.order(), ElementsAre(1, 0)) << "numbered among the transparent ones";
    // Vertices 8 to 11 are the third rectangle's, 0 to 3 the first one's.
    EXPECT_THAT(sort.indices(), ElementsAre(8, 9, 10, 8, 10, 11, 0, 1, 2, 0, 2, 3));
}

TEST(DepthSort, ScenesWithoutACameraAreNotTurned) {
    const Geometry geometry = layers_at({0.25f, 0.75f, 0.5f});
    EXPECT_EQ(sorted(geometry, 1), sorted(geometry));
}

/// Random points in front of a camera at the origin that looks along -z, as small triangles.
Geometry points(std::size_t count, unsigned seed) {
    Random random(seed);
    Geometry geometry;
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::vec3 at(random.between(-1, 1), random.between(-1, 1), -random.between(2, 4));
        for (const glm::vec3& corner : {glm::vec3(0.01f, 0, 0), glm::vec3(0, 0.01f, 0), glm::vec3(-0.01f, -0.01f, 0)}) {
            geometry.indices.push_back(static_cast<std::uint32_t>(geometry.vertices.size()));
            geometry.vertices.push_back({at + corner, {0, 0}, {1, 1, 1, 0.5f}, i});
        }
        geometry.primitives.push_back({3 * i, 3, -at.z, false});
    }
    geometry.view_projection = glm::mat4(0);
    geometry.view_projection[0][0] = geometry.view_projection[1][1] = 1;
    geometry.view_projection[2][2] = -2;
    geometry.view_projection[3][2] = -4;
    geometry.view_projection[2][3] = -1;  // w grows with the distance
    geometry.camera = {{"eye", {0, 0, 0}}};
    return geometry;
}

/// In double precision along a direction.
std::vector<std::uint32_t> by_standard_sort(const Geometry& geometry, const glm::dvec3& direction) {
    std::vector<double> depths;
    for (const Primitive& primitive : geometry.primitives) {
        double depth = 0;
        for (std::uint32_t i = 0; i < 3; ++i)
            depth += glm::dot(direction, glm::dvec3(geometry.vertices[primitive.first_index + i].position));
        depths.push_back(depth / 3);
    }
    std::vector<std::uint32_t> order(depths.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, [&](std::uint32_t a, std::uint32_t b) { return depths[a] > depths[b]; });
    return order;
}

TEST(DepthSort, FollowsTheCameraAroundTheScene) {
    const Geometry geometry = points(500, 7);
    const glm::dvec3 ahead(0, 0, -1);
    EXPECT_EQ(sorted(geometry), by_standard_sort(geometry, ahead));
    // The side is across the axis and the x axis: (0, 0, -1) x (1, 0, 0) = (0, -1, 0).
    const double turn = 0.4;
    const glm::dvec3 turned = std::cos(turn) * ahead + std::sin(turn) * glm::dvec3(0, -1, 0);
    EXPECT_EQ(sorted(geometry, turn), by_standard_sort(geometry, turned));
    EXPECT_NE(sorted(geometry, turn), sorted(geometry));
}

TEST(DepthSort, AComparisonTimesItForMethodsThatSort) {
    const Spec spec = parse_spec({{"scene", {{"type", "quads"}, {"count", 20}, {"shading", "constant"}}},
                                  {"methods",
                                   {"b2f",
                                    "unsorted",
                                    {{"id", "exact"}, {"form", "sorted"}},
                                    {{"id", "exact"}, {"form", "lists"}, {"label", "lists"}}}},
                                  {"image", {{"width", 16}, {"height", 16}}},
                                  {"timing", {{"rounds", 3}}}});
    const auto context = make_context("egl");
    NoAssets assets;
    std::vector<sheer::Run> runs;
    compare(
        spec, *context, assets, [](double, const std::string&) {}, [&](const sheer::Run& run) { runs.push_back(run); });
    const std::vector<bool> sorts = {true, false, true, false};
    for (std::size_t i = 0; i < 4; ++i) {
        const MethodResult& result = runs.at(0).results[i];
        EXPECT_EQ(result.status, report::ResultStatus::ok) << result.reason;
        EXPECT_EQ(result.sorts, sorts[i]) << result.method.label;
        EXPECT_EQ(result.sort_ms.size(), sorts[i] ? 3u : 0u) << result.method.label;
        for (const double time_ms : result.sort_ms) EXPECT_GT(time_ms, 0);
    }
    EXPECT_EQ(runs[0].baseline_again_sort_ms.size(), 3u);
    EXPECT_EQ(runs[0].no_sort_reason, "");
}

}  // namespace

}  // namespace sheer::test::depth_sort_test
