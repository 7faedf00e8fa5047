// The slices of the volume scene as geometry, and the built-in head as voxels.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/scene/camera.h"
#include "renderer/scene/scene_info.h"
#include "renderer/spec/spec.h"

namespace sheer::volume_scene_test {

namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

class HandVolume : public NoAssets {
  public:
    explicit HandVolume(Volume volume) : m_volume(std::move(volume)) {}
    Volume volume(const std::string&, const VolumeOptions& options) override {
        m_options = options;
        return m_volume;
    }
    VolumeOptions m_options;

  private:
    Volume m_volume;
};

HandVolume hand_volume(const glm::dvec3& spacing = glm::dvec3(1)) {
    return HandVolume({.size = {1, 1, 1}, .spacing = spacing, .bytes = {128}, .floats = {}});
}

Spec spec_of(const json& fields, int width_px = 64, int height_px = 64) {
    json scene = {{"type", "volume"}, {"volume", {{"data", "by hand"}}}, {"frame", false}};
    scene.update(fields);
    return parse_spec(
        {{"scene", scene}, {"methods", {"b2f"}}, {"image", {{"width", width_px}, {"height", height_px}}}});
}

Geometry build(const json& fields, AssetReader& assets, int width_px = 64, int height_px = 64) {
    const Spec spec = spec_of(fields, width_px, height_px);
    return build_geometry(spec.scene, spec.image, assets);
}

json camera(const std::array<double, 3>& eye) {
    return {{"eye", eye}, {"target", {0, 1.5, 0}}};
}

double area_of(const Geometry& geometry, const Primitive& primitive) {
    double area = 0;
    for (std::uint32_t i = 0; i < primitive.index_count; i += 3) {
        const auto corner = [&](std::uint32_t j) {
            return glm::dvec3(geometry.vertices[geometry.indices[primitive.first_index + i + j]].position);
        };
        const double z = glm::cross(corner(1) - corner(0), corner(2) - corner(0)).z;
        EXPECT_GE(z, -1e-6) << "a triangle of a convex polygon with the opposite orientation";
        area += z / 2;
    }
    return area;
}

/// A cube of side 2 viewed along an axis: squares of area 4, evenly spaced from back to front.
TEST(VolumeSlices, OfACubeAlongAnAxisAreSquares) {
    auto assets = hand_volume();
    for (const std::array<double, 3>& eye : {std::array{0.0, 1.5, 5.0}, {-5.0, 1.5, 0.0}}) {
        const Geometry geometry = build({{"slices", 10}, {"camera", camera(eye)}}, assets);
        ASSERT_EQ(geometry.primitives.size(), 10u);
        EXPECT_TRUE(geometry.parallel);
        for (std::size_t i = 0; i < 10; ++i) {
            EXPECT_NEAR(geometry.primitives[i].depth, 5 + 1 - 0.2 * (static_cast<double>(i) + 0.5), 1e-5);
            EXPECT_NEAR(area_of(geometry, geometry.primitives[i]), 4, 1e-5);
        }
    }
}

/// Along its diagonal a cube of side 2 is 2 sqrt(3) deep, and its middle slice is a regular hexagon of side sqrt(2),
/// which has the area 3 sqrt(3); near the corners slices are triangles.
TEST(VolumeSlices, OfACubeAlongItsDiagonalGoFromTrianglesToAHexagon) {
    auto assets = hand_volume();
    const Geometry geometry = build({{"slices", 9}, {"camera", camera({3, 4.5, 3})}}, assets);
    const double depth = 2 * std::sqrt(3.0);
    for (std::size_t i = 0; i < 9; ++i)
        EXPECT_NEAR(geometry.primitives[i].depth,
                    std::sqrt(27.0) + depth / 2 - depth / 9 * (static_cast<double>(i) + 0.5), 1e-5);
    EXPECT_EQ(geometry.primitives[0].index_count, 3u);
    EXPECT_EQ(geometry.primitives[4].index_count, 12u);
    EXPECT_NEAR(area_of(geometry, geometry.primitives[4]), 3 * std::sqrt(3.0), 1e-5);
    // The first plane is d = depth / 18 from the corner; that triangle has the area 3 sqrt(3) / 2 d^2.
    EXPECT_NEAR(area_of(geometry, geometry.primitives[0]), 1.5 * std::sqrt(3.0) * std::pow(depth / 18, 2), 1e-5);
}

/// Area times distance, summed, is the volume of the box (midpoint rule), from any side and from within.
TEST(VolumeSlices, AddUpToTheBox) {
    auto assets = hand_volume({1, 0.5, 0.8});
    for (const std::array<double, 3>& eye :
         {std::array{4.0, 3.0, 1.0}, {-1.0, -4.0, 2.0}, {0.3, 1.6, 0.1}, {0.0, 1.5, -7.0}, {4.0, 1.5, 4.0}}) {
        const Geometry geometry = build({{"slices", 500}, {"camera", camera(eye)}}, assets);
        ASSERT_EQ(geometry.primitives.size(), 500u);
        const double distance = double{geometry.primitives[0].depth} - geometry.primitives[1].depth;
        double sum = 0;
        for (const Primitive& primitive : geometry.primitives) sum += area_of(geometry, primitive) * distance;
        EXPECT_NEAR(sum, 2 * 1 * 1.6, 3e-3);
    }
}

/// Drawing slices in depth order is exact only because each has a single depth, to the last bit.
TEST(VolumeSlices, HaveOneDepthEach) {
    auto assets = hand_volume();
    const Geometry geometry = build({{"slices", 100}, {"camera", camera({3, 5, 2})}}, assets);
    for (const Vertex& vertex : geometry.vertices) {
        EXPECT_EQ(vertex.position.z, -geometry.primitives[vertex.primitive].depth);
        EXPECT_GE(std::min(vertex.uv.x, vertex.uv.y), 0);
        EXPECT_LE(std::max(vertex.uv.x, vertex.uv.y), 1);
    }
}

/// The corners of the slices are on the box, whose corners are those of the texture.
TEST(VolumeSlices, LieOnTheTexture) {
    auto assets = hand_volume({1, 0.5, 0.8});
    const Geometry geometry = build({{"slices", 300}, {"camera", camera({4, 3, 1})}}, assets);
    ASSERT_TRUE(geometry.volume);
    glm::vec3 low(1), high(0);
    for (const Vertex& vertex : geometry.vertices) {
        const glm::vec3 at = geometry.volume->to_texture * glm::vec4(vertex.position, 1);
        int on_faces = 0;
        for (int axis = 0; axis < 3; ++axis) on_faces += std::min(std::abs(at[axis]), std::abs(1 - at[axis])) < 1e-5f;
        EXPECT_GE(on_faces, 2);
        low = glm::min(low, at);
        high = glm::max(high, at);
    }
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(low[axis], 0, 1e-5);
        EXPECT_NEAR(high[axis], 1, 1e-5);
    }
}

TEST(VolumeFrame, IsOpaqueAndCanBeLeftOut) {
    auto assets = hand_volume();
    const Geometry with = build({{"slices", 5}, {"frame", true}}, assets), without = build({{"slices", 5}}, assets);
    EXPECT_EQ(without.primitives.size(), 5u);
    EXPECT_EQ(std::ranges::count(with.primitives, false, &Primitive::opaque), 5);
    EXPECT_GT(with.primitives.size(), 10u);
    for (const Vertex& vertex : with.vertices)
        EXPECT_EQ(vertex.uv == untextured_uv, with.primitives[vertex.primitive].opaque);
}

TEST(VolumeFrame, IsInThePictureAtAnyAspect) {
    for (const auto& [width_px, height_px] : {std::pair{64, 64}, {128, 32}, {32, 128}}) {
        auto assets = hand_volume();
        const Geometry geometry = build({{"slices", 50}, {"frame", true}}, assets, width_px, height_px);
        float widest = 0;
        for (const Vertex& vertex : geometry.vertices) {
            const glm::vec4 clip = geometry.view_projection * glm::vec4(vertex.position, 1);
            const glm::vec3 at = glm::vec3(clip) / clip.w;
            ASSERT_LE(std::max(std::abs(at.x), std::abs(at.y)), 1);
            ASSERT_GE(at.z, 0);
            ASSERT_LE(at.z, 1);
            widest = std::max({widest, std::abs(at.x), std::abs(at.y)});
        }
        EXPECT_GT(widest, 0.7f);
    }
}

/// The alpha of a point is for a thickness of 1/256 of the longest side: here 2/256, while a slice is 2/64 thick.
TEST(VolumeTransfer, IsBakedForTheDistanceOfTheSlices) {
    auto assets = hand_volume();
    const json points = {{{"value", 0.25}, {"color", {1, 0, 0}}, {"alpha", 0}},
                         {{"value", 0.75}, {"color", {0, 1, 0}}, {"alpha", 0.5}}};
    const Geometry geometry =
        build({{"slices", 64}, {"transfer", points}, {"density", 0.75}, {"camera", camera({0, 1.5, 5})}}, assets);
    const auto& baked = geometry.volume->transfer;
    ASSERT_GE(baked.size(), 256u);
    for (std::size_t i = 0; i < baked.size(); ++i) {
        const double value = static_cast<double>(i) / static_cast<double>(baked.size() - 1);
        const double along = std::clamp((value - 0.25) / 0.5, 0.0, 1.0);
        EXPECT_NEAR(baked[i].r, 1 - along, 1e-6);
        EXPECT_NEAR(baked[i].g, along, 1e-6);
        EXPECT_NEAR(baked[i].a, 1 - std::pow(1 - 0.5 * along, 0.75 * 256 / 64), 1e-6);
    }
}

struct WrongSpec {
    json fields;
    std::string pointer, detail;
};

TEST(VolumeSpec, WrongFieldsAreNamed) {
    const json point = {{"value", 0.5}, {"color", {1, 1, 1}}, {"alpha", 0.5}};
    const WrongSpec rows[] = {
        {{{"slices", 2049}}, "/scene/slices", "1 to 2048"},
        {{{"transfer", json::array()}}, "/scene/transfer", "1 to 64"},
        {{{"transfer", {point, point}}}, "/scene/transfer/1/value", "must be greater than that of the previous point"},
        {{{"transfer", {point, {{"value", 2}, {"color", {1, 1, 1}}, {"alpha", 0}}}}},
         "/scene/transfer/1/value",
         "from 0 to 1"},
        {{{"volume", {{"resolution", 31}}}}, "/scene/volume/resolution", "32 to 512"},
        {{{"volume", {{"data", "x"}, {"raw", {{"size", {2, 2.5, 2}}}}}}}, "/scene/volume/raw/size/1", "whole number"},
        {{{"volume", {{"data", "x"}, {"raw", {{"size", {2, 2, 1025}}}}}}}, "/scene/volume/raw/size/2", "1 to 1024"},
        {{{"volume", {{"data", "x"}, {"raw", {{"voxel", "uint8"}}}}}}, "/scene/volume/raw/size", "is missing"},
        {{{"volume", {{"raw", {{"size", {2, 2, 2}}}}}}}, "/scene/volume/raw", "not apply to the built-in head"},
        {{{"volume", {{"range", {0, 1}}}}}, "/scene/volume/range", "not apply to the built-in head"},
        {{{"volume", {{"data", "x"}, {"range", {7, 7}}}}}, "/scene/volume/range/1", "must be greater than the first"},
        {{{"volume", {{"data", "x"}, {"range", {1}}}}}, "/scene/volume/range", "array of 2 numbers"},
        {{{"camera", {{"eye", {1, 1, 1}}, {"target", {1, 1, 1}}}}}, "/scene/camera/target", "must differ from eye"}};
    for (const WrongSpec& row : rows) {
        try {
            spec_of(row.fields);
            ADD_FAILURE() << row.fields << " is accepted";
        } catch (const SpecError& error) {
            ASSERT_EQ(error.errors().size(), 1u) << row.fields << error.what();
            EXPECT_EQ(error.errors()[0].pointer, row.pointer);
            EXPECT_THAT(error.errors()[0].detail, HasSubstr(row.detail));
        }
    }
}

TEST(VolumeSpec, RawLayoutGoesToTheReader) {
    auto assets = hand_volume();
    build({{"volume", {{"data", "x"}, {"raw", {{"size", {2, 3, 4}}, {"voxel", "uint16"}, {"spacing", {1, 2, 0.5}}}}}}},
          assets);
    ASSERT_TRUE(assets.m_options.raw);
    EXPECT_EQ(assets.m_options.raw->size, glm::ivec3(2, 3, 4));
    EXPECT_EQ(assets.m_options.raw->spacing, glm::dvec3(1, 2, 0.5));
    EXPECT_EQ(assets.m_options.raw->voxel, "uint16");
    EXPECT_FALSE(assets.m_options.raw->big_endian);
    EXPECT_FALSE(assets.m_options.range);
}

TEST(VolumeSpec, RangeGoesToTheReader) {
    auto assets = hand_volume();
    build({{"volume", {{"data", "x"}, {"range", {-1000, 2000.5}}}}}, assets);
    EXPECT_FALSE(assets.m_options.raw);
    EXPECT_EQ(assets.m_options.range, glm::dvec2(-1000, 2000.5));
}

/// Bytes 50 and 250 represent 0 and 1; the texture gives 0..1 for 0..255.
TEST(VolumeSpec, BytesAreScaledByTheRange) {
    HandVolume assets({.size = {1, 1, 1}, .bytes = {128}, .floats = {}, .byte_range = {50, 250}});
    const glm::vec2 value = build(json::object(), assets).volume->value;
    EXPECT_NEAR(50.0 / 255 * value.x + value.y, 0, 1e-6);
    EXPECT_NEAR(250.0 / 255 * value.x + value.y, 1, 1e-6);
    auto usual = hand_volume();
    EXPECT_EQ(build(json::object(), usual).volume->value, glm::vec2(1, 0));
}

TEST(VolumeSpec, AMissingFileIsNamed) {
    NoAssets none;
    try {
        build(json::object(), none);
        FAIL();
    } catch (const SpecError& error) {
        EXPECT_EQ(error.errors().at(0).pointer, "/scene/volume/data");
    }
}

constexpr int head_size = 64;

/// The value at a place in the head's own units: the box is from -1 to 1 along y.
double value_at(const Volume& head, const glm::dvec3& at) {
    const glm::dvec3 half = head.sides(), middle(0, 0, 0.04);
    const glm::ivec3 voxel((at - middle + half) / (2.0 * half) * double{head_size});
    return head.bytes[static_cast<std::size_t>((voxel.z * head_size + voxel.y) * head_size + voxel.x)] / 255.0;
}

TEST(Head, IsSymmetricAndHasAirAroundIt) {
    const Volume head = make_head(head_size);
    ASSERT_EQ(head.bytes.size(), static_cast<std::size_t>(head_size * head_size * head_size));
    for (std::size_t row = 0; row < head.bytes.size(); row += head_size)
        for (std::size_t x = 0; x < head_size / 2; ++x)
            ASSERT_EQ(head.bytes[row + x], head.bytes[row + head_size - 1 - x]);
    // All faces of the box except the one that cuts the neck.
    for (int a = 0; a < head_size; ++a)
        for (int b = 0; b < head_size; ++b) {
            const auto at = [&](int x, int y, int z) {
                return head.bytes[static_cast<std::size_t>((z * head_size + y) * head_size + x)];
            };
            ASSERT_EQ(at(0, a, b) + at(a, head_size - 1, b) + at(a, b, 0) + at(a, b, head_size - 1), 0);
        }
}

/// From the forehead inwards: air, skin, bone, brain.
TEST(Head, HasItsMaterialsWhereTheyBelong) {
    const Volume head = make_head(head_size);
    const double tolerance = 0.02;
    EXPECT_EQ(value_at(head, {0.6, 0.9, 0.7}), HeadValues::air);
    EXPECT_NEAR(value_at(head, {0.3, 0.4, -0.1}), HeadValues::brain, tolerance);
    EXPECT_NEAR(value_at(head, {0.33, -0.2, 0.05}), HeadValues::bone, 0.15) << "the jaw";
    EXPECT_NEAR(value_at(head, {0, -0.1, -0.65}), HeadValues::air, tolerance) << "behind the neck";
    EXPECT_NEAR(value_at(head, {0.12, -0.6, -0.08}), HeadValues::flesh, tolerance) << "the neck";
    EXPECT_NEAR(value_at(head, {0.19, 0.155, 0.505}), HeadValues::eye, tolerance);
    double brightest = 0;
    for (double z = 0.35; z < 0.65; z += 0.01) brightest = std::max(brightest, value_at(head, {0.2, 0.5, z}));
    EXPECT_GT(brightest, 0.65) << "there is bone behind the forehead";
}

/// FNV-1a over the voxels: the same on every platform and at every level of optimisation.
TEST(Head, IsTheSameEverywhere) {
    std::uint64_t hash = 14695981039346656037u;
    for (const std::uint8_t byte : make_head(32).bytes) hash = (hash ^ byte) * 1099511628211u;
    EXPECT_EQ(hash, 17336386929914346809u);
}

/// Blocks far from any surface are filled from their middles; a grid that is not a multiple of the block size shows no
/// seams.
TEST(Head, OfAnySizeHasAsMuchBone) {
    const auto share = [](int size) {
        const Volume head = make_head(size);
        const auto bone = std::ranges::count_if(head.bytes, [](std::uint8_t value) { return value > 170; });
        return static_cast<double>(bone) / static_cast<double>(head.voxel_count());
    };
    const double usual = share(64);
    EXPECT_GT(usual, 0.02);
    EXPECT_NEAR(share(67), usual, 0.2 * usual);
}

}  // namespace

}  // namespace sheer::volume_scene_test
