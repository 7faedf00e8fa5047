// The scene `gltf`: from files to geometry.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "renderer/assets/check_asset.h"
#include "renderer/assets/file_assets.h"
#include "renderer/scene/asset_kinds.h"
#include "renderer/scene/scene_info.h"
#include "renderer/spec/spec.h"
#include "tests/unit/glb_writer.h"
#include "tests/unit/temporary_folder.h"

namespace sheer::test::gltf_scene_test {

namespace {

using nlohmann::json;
using testing::HasSubstr;

/// A square of two triangles that faces along z, in its own file.
GlbWriter square(const std::string& alpha_mode, const std::vector<float>& normals = {}) {
    GlbWriter writer;
    json attributes = {
        {"POSITION", writer.accessor(std::vector<float>{-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}, "VEC3")}};
    if (!normals.empty()) attributes["NORMAL"] = writer.accessor(normals, "VEC3");
    const int indices = writer.accessor(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, "SCALAR");
    writer.root({{"mesh", writer.mesh(attributes, indices, writer.material(alpha_mode, {1, 1, 1, 0.5}))}});
    return writer;
}

class GltfScene : public testing::Test {
  protected:
    Geometry build(const std::string& bytes, json scene = json::object()) {
        scene["type"] = "gltf";
        scene["model"] = m_folder.file("model.glb", bytes).filename();
        const Spec spec = parse_spec({{"scene", scene}, {"methods", {"b2f"}}});
        FileAssets assets = assets_in_folder(m_folder.path());
        return build_geometry(spec.scene, spec.image, assets);
    }

    TemporaryFolder m_folder;
};

TEST_F(GltfScene, BlendedTrianglesAreSortedOneByOne) {
    const json camera = {{"eye", {3, 0, 4}}, {"target", {0, 0, 0}}};
    const Geometry geometry = build(square("BLEND").glb(), {{"camera", camera}});
    ASSERT_EQ(geometry.primitives.size(), 2u);
    // The view is along (-0.6, 0, -0.8) from a distance of 5. The triangles' middles are (1/3, -1/3, 0) and (-1/3, 1/3,
    // 0).
    EXPECT_FALSE(geometry.primitives[0].opaque);
    EXPECT_NEAR(geometry.primitives[0].depth, 5 - 0.2, 1e-5);
    EXPECT_NEAR(geometry.primitives[1].depth, 5 + 0.2, 1e-5);
    EXPECT_FALSE(geometry.parallel);
    EXPECT_EQ(geometry.vertices.size(), 6u);
}

TEST_F(GltfScene, OpaqueAndMaskedOnesAreNot) {
    const std::vector<float> normals = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    for (const std::string alpha_mode : {"OPAQUE", "MASK"}) {
        const Geometry geometry = build(square(alpha_mode, normals).glb());
        ASSERT_EQ(geometry.primitives.size(), 1u);
        EXPECT_TRUE(geometry.primitives[0].opaque);
        EXPECT_EQ(geometry.vertices.size(), 4u);
        ASSERT_EQ(geometry.materials.size(), 1u);
        // The mask's own alpha of 0.5 equals its cutoff: only a texture could bring it under the cutoff.
        EXPECT_NEAR(geometry.materials[0].cutoff, alpha_mode == "MASK" ? 1 : 0, 1e-4);
        EXPECT_LE(geometry.materials[0].cutoff, 1);
    }
}

/// A surface that faces up gets all of the sky, and of the sun from (-0.5, 0.8, 0.55) the cosine; one that faces down
/// gets neither.
TEST_F(GltfScene, DaylightIsBakedUnlessRefused) {
    const std::vector<float> up = {0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0}, down = {0, -1, 0, 0, -1, 0, 0, -1, 0, 0, -1, 0};
    const glm::vec4 light = build(square("BLEND", up).glb()).vertices[0].tint;
    EXPECT_NEAR(light.r, 0.20 + 0.18 + 0.80 * 0.8 / std::sqrt(0.25 + 0.64 + 0.3025), 1e-6);
    EXPECT_EQ(light.a, 0.5f);
    const glm::vec4 dark = build(square("BLEND", down).glb()).vertices[0].tint;
    EXPECT_NEAR(dark.r, 0.20, 1e-6);
    EXPECT_NEAR(dark.b, 0.26, 1e-6);
    EXPECT_EQ(dark.a, 0.5f);
    EXPECT_EQ(build(square("BLEND", down).glb(), {{"light", "none"}}).vertices[0].tint, glm::vec4(1, 1, 1, 0.5f));
    GlbWriter unlit = square("BLEND", down);
    unlit.document["materials"][0]["extensions"]["KHR_materials_unlit"] = json::object();
    EXPECT_EQ(build(unlit.glb()).vertices[0].tint, glm::vec4(1, 1, 1, 0.5f));
}

TEST_F(GltfScene, IsFramed) {
    const Geometry geometry = build(square("OPAQUE").glb());
    for (const Vertex& vertex : geometry.vertices) {
        const glm::vec4 clip = geometry.view_projection * glm::vec4(vertex.position, 1);
        EXPECT_LE(std::abs(clip.x), clip.w);
        EXPECT_LE(std::abs(clip.y), clip.w);
    }
}

TEST_F(GltfScene, TextureCoordinatesNeverMeanUntextured) {
    GlbWriter writer = square("OPAQUE");
    const int texture = writer.texture(make_png(1, 1, {255, 255, 255, 255}));
    writer.document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = texture;
    writer.document["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
        writer.accessor(std::vector<float>{-2.5f, -0.25f, 1, 0, 1, 1, 0, 1}, "VEC2");
    const Geometry geometry = build(writer.glb());
    EXPECT_EQ(geometry.vertices[0].uv, glm::vec2(-2.5f, -0.25f));
    for (const Vertex& vertex : geometry.vertices) EXPECT_GT(vertex.uv.x, untextured_uv.x / 10);
    EXPECT_EQ(geometry.materials[0].base.array, 0);
    EXPECT_EQ(geometry.pictures.size(), 1u);
}

std::string pointer_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const SpecError& error) {
        return error.errors().at(0).pointer + " " + error.errors().at(0).detail;
    }
    return "no error";
}

TEST_F(GltfScene, AModelThatCannotBeReadIsAnErrorAtItsField) {
    EXPECT_THAT(pointer_of([&] { build("nonsense"); }), HasSubstr("/scene/model the file is neither"));
    EXPECT_THAT(pointer_of([] {
                    parse_spec({{"scene", {{"type", "gltf"}}}, {"methods", {"b2f"}}});
                }),
                HasSubstr("/scene/model is missing"));
}

TEST_F(GltfScene, UploadsAreChecked) {
    const std::string glb = square("BLEND").glb(), gltf = square("BLEND").gltf();
    const json facts = {{"triangles", 2}, {"materials", 1}, {"pictures", 0}, {"notes", json::array()}};
    EXPECT_EQ(check_asset(m_folder.file("a", glb), "model/gltf-binary"), facts);
    EXPECT_EQ(check_asset(m_folder.file("b", gltf), "model/gltf+json"), facts);
    EXPECT_THROW(check_asset(m_folder.file("a", glb), "model/gltf+json"), AssetError);
    EXPECT_THROW(check_asset(m_folder.file("b", gltf), "model/gltf-binary"), AssetError);
    EXPECT_THROW(check_asset(m_folder.file("c", glb.substr(0, 400)), "model/gltf-binary"), AssetError);
    EXPECT_EQ(find_asset_kind("model/gltf-binary")->type, "model");
}

}  // namespace

}  // namespace sheer::test::gltf_scene_test
