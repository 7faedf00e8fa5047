#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "renderer/core/random.h"
#include "renderer/scene/scene_info.h"
#include "renderer/scene/textures.h"
#include "renderer/spec/spec.h"

namespace sheer::scene_test {

namespace {

using nlohmann::json;

Geometry build_quads(const json& fields, int width_px = 512, int height_px = 512) {
    json scene = {{"type", "quads"}};
    scene.update(fields);
    const Spec spec =
        parse_spec({{"scene", scene}, {"methods", {"b2f"}}, {"image", {{"width", width_px}, {"height", height_px}}}});
    NoAssets assets;
    return build_geometry(spec.scene, spec.image, assets);
}

/// Left, top, right, bottom in pixels from the top left.
struct Box {
    double x0, y0, x1, y1;
    double width() const { return x1 - x0; }
    double height() const { return y1 - y0; }
};

std::vector<Box> boxes_px(const Geometry& geometry, double width_px, double height_px) {
    std::vector<Box> all;
    for (const Primitive& primitive : geometry.primitives) {
        Box box{1e9, 1e9, -1e9, -1e9};
        for (std::uint32_t i = 0; i < primitive.index_count; ++i) {
            const glm::vec3 at = geometry.vertices[geometry.indices[primitive.first_index + i]].position;
            const double x = (at.x + 1) / 2 * width_px, y = (1 - at.y) / 2 * height_px;
            box = {std::min(box.x0, x), std::min(box.y0, y), std::max(box.x1, x), std::max(box.y1, y)};
        }
        all.push_back(box);
    }
    return all;
}

/// Published first outputs of SplitMix64 for the seed 1234567.
TEST(Random, IsSplitMix64) {
    Random random(1234567);
    EXPECT_EQ(random.next(), 6457827717110365317u);
    EXPECT_EQ(random.next(), 3203168211198807973u);
    EXPECT_EQ(random.next(), 9817491932198370423u);
}

struct SizeRow {
    std::string distribution;
    double min_px, max_px, centre_spread;
};

/// Section 3 of the paper, in its window of 512 x 512 pixels.
class QuadSizes : public testing::TestWithParam<SizeRow> {};

TEST_P(QuadSizes, AreThoseOfThePaper) {
    const SizeRow& row = GetParam();
    const Geometry geometry = build_quads({{"distribution", row.distribution}, {"count", 500}});
    ASSERT_EQ(geometry.primitives.size(), 500u);
    double smallest = 1e9, largest = 0, furthest = 0;
    for (const Box& box : boxes_px(geometry, 512, 512)) {
        EXPECT_NEAR(box.width(), box.height(), 1e-3);
        EXPECT_GE(box.x0, -1e-3);
        EXPECT_GE(box.y0, -1e-3);
        EXPECT_LE(box.x1, 512.001);
        EXPECT_LE(box.y1, 512.001);
        smallest = std::min(smallest, box.width());
        largest = std::max(largest, box.width());
        for (const double middle : {(box.x0 + box.x1) / 2, (box.y0 + box.y1) / 2})
            furthest = std::max(furthest, std::abs(middle / 512 - 0.5));
    }
    EXPECT_GE(smallest, row.min_px - 1e-3);
    EXPECT_LE(largest, row.max_px + 1e-3);
    // Of 500 quads some come within 2 % of the ends of the range.
    EXPECT_LE(smallest, row.min_px + 0.02 * (row.max_px - row.min_px) + 1e-3);
    EXPECT_GE(largest, row.max_px - 0.02 * (row.max_px - row.min_px) - 1e-3);
    if (row.centre_spread > 0) {
        EXPECT_LE(furthest, row.centre_spread + 1e-6);
        EXPECT_GE(furthest, 0.98 * row.centre_spread);
    }
}

INSTANTIATE_TEST_SUITE_P(All, QuadSizes,
                         testing::Values(SizeRow{"random", 26, 256, 0}, SizeRow{"small", 154, 154, 0},
                                         SizeRow{"big", 307, 307, 0}, SizeRow{"full", 512, 512, 0},
                                         SizeRow{"thick", 154, 154, 0.1}, SizeRow{"medium", 154, 154, 0.2},
                                         SizeRow{"scarce", 154, 154, 0.35}),
                         [](const testing::TestParamInfo<SizeRow>& row) { return row.param.distribution; });

TEST(Quads, StaySquareAndVisibleInAWideImage) {
    const Geometry geometry = build_quads({{"distribution", "big"}, {"count", 100}}, 1024, 256);
    for (const Box& box : boxes_px(geometry, 1024, 256)) {
        EXPECT_NEAR(box.width(), 256 * 307.0 / 512, 1e-2);
        EXPECT_NEAR(box.width(), box.height(), 1e-2);
        EXPECT_LE(box.x1, 1024.01);
        EXPECT_LE(box.y1, 256.01);
    }
}

TEST(Quads, HaveDistinctDepthsAndDependOnTheSeed) {
    const Geometry first = build_quads({{"count", 300}, {"seed", 5}}),
                   again = build_quads({{"count", 300}, {"seed", 5}}),
                   other = build_quads({{"count", 300}, {"seed", 6}});
    std::set<float> depths;
    for (std::size_t i = 0; i < 300; ++i) {
        depths.insert(first.primitives[i].depth);
        EXPECT_EQ(first.primitives[i].depth, again.primitives[i].depth);
        EXPECT_EQ(first.vertices[4 * i].position, again.vertices[4 * i].position);
    }
    EXPECT_EQ(depths.size(), 300u);
    EXPECT_GT(*depths.begin(), 0);
    EXPECT_LT(*depths.rbegin(), 1);
    EXPECT_NE(first.vertices[0].position, other.vertices[0].position);
}

/// FNV-1a over the bytes: the same on every platform, so that a change of the picture is noticed.
std::uint64_t checksum(const std::vector<std::uint8_t>& bytes) {
    std::uint64_t hash = 14695981039346656037u;
    for (const std::uint8_t byte : bytes) hash = (hash ^ byte) * 1099511628211u;
    return hash;
}

class Textures : public testing::TestWithParam<std::string> {};

TEST_P(Textures, HaveAllMipmapsAndFourVariants) {
    std::set<std::uint64_t> pictures;
    for (int variant = 0; variant < 4; ++variant) {
        const auto levels = make_texture(GetParam(), 64, variant);
        ASSERT_EQ(levels.size(), 7u);
        for (std::size_t level = 0; level < levels.size(); ++level) {
            EXPECT_EQ(levels[level].size_px, 64 >> level);
            EXPECT_EQ(levels[level].rgba.size(),
                      static_cast<std::size_t>(levels[level].size_px) * levels[level].size_px * 4);
        }
        pictures.insert(checksum(levels[0].rgba));
        // The last level keeps the mean alpha of the whole picture: seven halvings round by half a level each.
        double sum = 0;
        for (std::size_t i = 3; i < levels[0].rgba.size(); i += 4) sum += levels[0].rgba[i];
        EXPECT_NEAR(levels[6].rgba[3], sum / (64 * 64), 3.5);
    }
    EXPECT_EQ(pictures.size(), 4u);
}

TEST_P(Textures, CoverAPartOfTheSquare) {
    const auto level = make_texture(GetParam(), 128, 0).front();
    std::size_t clear = 0, dense = 0;
    for (std::size_t i = 3; i < level.rgba.size(); i += 4) {
        clear += level.rgba[i] < 8;
        dense += level.rgba[i] > 100;
    }
    const std::size_t texels = 128 * 128;
    EXPECT_GT(clear, texels / 10);
    EXPECT_GT(dense, texels / 20);
}

INSTANTIATE_TEST_SUITE_P(All, Textures, testing::Values("leaf", "smoke"),
                         [](const testing::TestParamInfo<std::string>& image) { return image.param; });

TEST(TexturesByName, UnknownOnesThrow) {
    EXPECT_THROW(make_texture("teapot", 4, 0), std::invalid_argument);
}

Geometry build_scene(const json& scene, int width_px = 64, int height_px = 64) {
    const Spec spec =
        parse_spec({{"scene", scene}, {"methods", {"b2f"}}, {"image", {{"width", width_px}, {"height", height_px}}}});
    NoAssets assets;
    return build_geometry(spec.scene, spec.image, assets);
}

std::size_t transparent_count(const Geometry& geometry) {
    return static_cast<std::size_t>(std::ranges::count(geometry.primitives, false, &Primitive::opaque));
}

struct Scene3dRow {
    std::string name;
    json scene, other_seed;
    std::size_t transparent;
};

void PrintTo(const Scene3dRow& row, std::ostream* out) {
    *out << row.scene;
}

class Scenes3d : public testing::TestWithParam<Scene3dRow> {};

TEST_P(Scenes3d, HaveAsManyTransparentPrimitivesAsAskedAndOpaqueOnes) {
    const Geometry geometry = build_scene(GetParam().scene);
    EXPECT_EQ(transparent_count(geometry), GetParam().transparent);
    EXPECT_LT(GetParam().transparent, geometry.primitives.size());
    std::size_t indices = 0;
    for (const Primitive& primitive : geometry.primitives) {
        EXPECT_EQ(primitive.first_index, indices);
        EXPECT_GT(primitive.index_count, 0u);
        EXPECT_TRUE(primitive.opaque || primitive.index_count == 6u);
        indices += primitive.index_count;
    }
    EXPECT_EQ(indices, geometry.indices.size());
    for (const std::uint32_t index : geometry.indices) ASSERT_LT(index, geometry.vertices.size());
    for (const Vertex& vertex : geometry.vertices)
        EXPECT_EQ(vertex.uv == untextured_uv, geometry.primitives[vertex.primitive].opaque);
}

/// The default camera shows the whole scene, between the near and the far plane, at any aspect ratio.
TEST_P(Scenes3d, AreFramed) {
    for (const auto& [width_px, height_px] : {std::pair{64, 64}, {128, 32}, {32, 128}}) {
        SCOPED_TRACE(width_px);
        const Geometry geometry = build_scene(GetParam().scene, width_px, height_px);
        float widest = 0;
        for (const Vertex& vertex : geometry.vertices) {
            const glm::vec4 clip = geometry.view_projection * glm::vec4(vertex.position, 1);
            const glm::vec3 at = glm::vec3(clip) / clip.w;
            ASSERT_LE(std::abs(at.x), 1);
            ASSERT_LE(std::abs(at.y), 1);
            ASSERT_GE(at.z, 0);
            ASSERT_LE(at.z, 1);
            widest = std::max({widest, std::abs(at.x), std::abs(at.y)});
        }
        EXPECT_GT(widest, 0.55f);
    }
}

TEST_P(Scenes3d, DependOnlyOnTheSeed) {
    const Geometry first = build_scene(GetParam().scene), again = build_scene(GetParam().scene),
                   other = build_scene(GetParam().other_seed);
    ASSERT_EQ(first.vertices.size(), again.vertices.size());
    std::size_t moved = 0;
    for (std::size_t i = 0; i < first.vertices.size(); ++i) {
        ASSERT_EQ(first.vertices[i].position, again.vertices[i].position);
        ASSERT_EQ(first.vertices[i].tint, again.vertices[i].tint);
        moved += i < other.vertices.size() && first.vertices[i].position != other.vertices[i].position;
    }
    EXPECT_GT(moved, 4 * GetParam().transparent / 2);
}

/// The depth for sorting is that of the middle of the primitive, along the view direction: clip w for a perspective.
TEST_P(Scenes3d, AreSortedByTheDepthOfTheirMiddles) {
    const Geometry geometry = build_scene(GetParam().scene);
    for (const Primitive& primitive : geometry.primitives) {
        if (primitive.opaque) continue;
        // The first and the third corner of a quad are opposite.
        const std::uint32_t* corners = &geometry.indices[primitive.first_index];
        const glm::vec3 middle =
            (geometry.vertices[corners[0]].position + geometry.vertices[corners[2]].position) / 2.0f;
        EXPECT_NEAR(primitive.depth, (geometry.view_projection * glm::vec4(middle, 1)).w, 1e-5);
    }
}

INSTANTIATE_TEST_SUITE_P(
    All, Scenes3d,
    testing::Values(Scene3dRow{"fire",
                               {{"type", "particles"}, {"count", 500}},
                               {{"type", "particles"}, {"count", 500}, {"seed", 2}},
                               500},
                    Scene3dRow{"smoke",
                               {{"type", "particles"}, {"count", 3000}, {"appearance", "smoke"}},
                               {{"type", "particles"}, {"count", 3000}, {"appearance", "smoke"}, {"seed", 2}},
                               3000},
                    Scene3dRow{"one_particle",
                               {{"type", "particles"}, {"count", 1}},
                               {{"type", "particles"}, {"count", 1}, {"seed", 2}},
                               1},
                    Scene3dRow{"one_tree",
                               {{"type", "foliage"}, {"trees", 1}, {"planes_per_tree", 40}},
                               {{"type", "foliage"}, {"trees", 1}, {"planes_per_tree", 40}, {"seed", 2}},
                               40},
                    Scene3dRow{"a_wood",
                               {{"type", "foliage"}, {"trees", 20}, {"planes_per_tree", 30}},
                               {{"type", "foliage"}, {"trees", 20}, {"planes_per_tree", 30}, {"seed", 2}},
                               600}),
    [](const testing::TestParamInfo<Scene3dRow>& row) { return row.param.name; });

/// Drawing sprites in depth order is exact only because each has a single depth, to the last bit.
TEST(Particles, FaceTheCamera) {
    const Geometry geometry = build_scene(
        {{"type", "particles"}, {"count", 200}, {"camera", {{"eye", {3, 5, 2}}, {"target", {0.3, 1, -0.2}}}}});
    EXPECT_TRUE(geometry.parallel);
    const auto clip_z = [&](std::uint32_t index) {
        return (geometry.view_projection * glm::vec4(geometry.vertices[index].position, 1)).z;
    };
    for (const Primitive& primitive : geometry.primitives) {
        if (primitive.opaque) continue;
        for (std::uint32_t i = 1; i < 6; ++i)
            EXPECT_EQ(clip_z(geometry.indices[primitive.first_index]),
                      clip_z(geometry.indices[primitive.first_index + i]));
    }
}

/// Half the diagonal and the alpha of each transparent sprite, in order.
std::vector<std::pair<float, float>> sprites_of(const json& fields) {
    json scene = {{"type", "particles"}};
    scene.update(fields);
    const Geometry geometry = build_scene(scene);
    std::vector<std::pair<float, float>> sprites;
    for (const Primitive& primitive : geometry.primitives) {
        if (primitive.opaque) continue;
        const auto vertex = [&](std::uint32_t i) {
            return geometry.vertices[geometry.indices[primitive.first_index + i]];
        };
        sprites.emplace_back(glm::length(vertex(0).position - vertex(2).position) / 2, vertex(0).tint.a);
    }
    return sprites;
}

/// With the same seed the first sprites are the same, however many there are.
TEST(Particles, KeepTheirSizeAndOpacityForAnyCountIfRequested) {
    const auto few = sprites_of({{"count", 50}, {"fit_count", false}}), usual = sprites_of({{"count", 2000}}),
               many = sprites_of({{"count", 4000}, {"fit_count", false}}), fitted = sprites_of({{"count", 32000}});
    for (std::size_t i = 0; i < few.size(); ++i) {
        EXPECT_FLOAT_EQ(few[i].first, usual[i].first);
        EXPECT_FLOAT_EQ(few[i].second, usual[i].second);
        EXPECT_FLOAT_EQ(many[i].first, usual[i].first);
        // Sixteen times as many have half the alpha and 2^-1.5 of the size.
        EXPECT_NEAR(fitted[i].second, usual[i].second / 2, 1e-6);
        EXPECT_NEAR(fitted[i].first, usual[i].first / std::pow(2, 1.5), 1e-6);
    }
}

TEST(Particles, HaveAnOpacity) {
    const auto usual = sprites_of({{"count", 20}}), half = sprites_of({{"count", 20}, {"opacity", 0.5}}),
               none = sprites_of({{"count", 20}, {"opacity", 0}});
    for (std::size_t i = 0; i < usual.size(); ++i) {
        EXPECT_FLOAT_EQ(half[i].second, usual[i].second / 2);
        EXPECT_EQ(none[i].second, 0);
        EXPECT_EQ(half[i].first, usual[i].first);
    }
    EXPECT_THROW(sprites_of({{"opacity", 1.01}}), SpecError);
    EXPECT_THROW(sprites_of({{"opacity", -0.01}}), SpecError);
}

TEST(Particles, AreAMillionAtMost) {
    const Geometry geometry = build_scene({{"type", "particles"}, {"count", 1000000}});
    EXPECT_EQ(transparent_count(geometry), 1000000u);
    EXPECT_THROW(build_scene({{"type", "particles"}, {"count", 1000001}}), SpecError);
    EXPECT_THROW(build_scene({{"type", "particles"}, {"count", 0}}), SpecError);
}

TEST(Particles, HaveSmokeAsTheirDefaultTexture) {
    const auto texture = [](const json& scene) {
        return parse_spec({{"scene", scene}, {"methods", {"b2f"}}}).scene.at("texture").at("image");
    };
    EXPECT_EQ(texture({{"type", "particles"}}), "smoke");
    EXPECT_EQ(texture({{"type", "particles"}, {"texture", {{"image", "leaf"}}}}), "leaf");
    EXPECT_EQ(texture({{"type", "foliage"}}), "leaf");
}

/// Randomly oriented planes: their normals have no preferred axis.
TEST(Foliage, PlanesHaveAllOrientations) {
    const Geometry geometry = build_scene({{"type", "foliage"}, {"trees", 2}, {"planes_per_tree", 1000}});
    EXPECT_FALSE(geometry.parallel);
    glm::dvec3 squares(0);
    for (const Primitive& primitive : geometry.primitives) {
        if (primitive.opaque) continue;
        const auto corner = [&](std::uint32_t i) {
            return glm::dvec3(geometry.vertices[geometry.indices[primitive.first_index + i]].position);
        };
        const glm::dvec3 right = corner(1) - corner(0), down = corner(2) - corner(1);
        EXPECT_NEAR(glm::dot(right, down), 0, 1e-5);
        EXPECT_NEAR(glm::length(right), glm::length(down), 1e-5);
        const glm::dvec3 normal = glm::normalize(glm::cross(right, down));
        squares += normal * normal;
    }
    // Mean 1/3 each; the standard deviation of a mean of 2000 is 0.3 / sqrt(2000) = 0.007.
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(squares[axis] / 2000, 1.0 / 3, 0.035);
}

TEST(Scenes, DescribeThemselves) {
    for (const SceneInfo& scene : all_scenes()) {
        SCOPED_TRACE(scene.id);
        EXPECT_FALSE(scene.name.empty());
        EXPECT_FALSE(scene.summary.empty());
        EXPECT_FALSE(scene.source.empty());
        EXPECT_TRUE(scene.build);
        for (const Param& param : scene.all_parameters()) EXPECT_FALSE(param.summary.empty()) << param.name;
    }
}

}  // namespace

}  // namespace sheer::scene_test
