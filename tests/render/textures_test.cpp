// Textures from files: which of the four shows what.
#include <set>
#include <sstream>

#include "renderer/scene/textures.h"
#include "tests/render/render_test.h"

namespace sheer::test::textures_test {

namespace {

using nlohmann::json;

/// Plain pictures that are named by their color: "0.25 0.5 1". Counts how often each is requested.
class PlainPictures : public NoAssets {
  public:
    explicit PlainPictures(std::multiset<std::string>& asked) : m_asked(asked) {}
    Picture picture(const std::string& name, int width_px, int height_px) override {
        m_asked.insert(name);
        std::istringstream words(name);
        float color[3] = {};
        words >> color[0] >> color[1] >> color[2];
        Picture picture{.image = Image(width_px, height_px), .notes = {{"a-note", "Of it.", ""}}};
        for (std::size_t i = 0; i < picture.image.pixel_count(); ++i) {
            std::copy_n(color, 3, &picture.image.rgba[4 * i]);
            picture.image.rgba[4 * i + 3] = 1;
        }
        return picture;
    }

  private:
    std::multiset<std::string>& m_asked;
};

/// Four quarters of the picture, each of which shows a texture.
json scene_with(const json& image) {
    return {{"type", "layers"},
            {"layers", {{{"depth", 0.5}, {"alpha", 1}}}},
            {"shading",
             {{"glsl",
               "int quarter = (uv.x < 0.5 ? 0 : 1) + (uv.y < 0.5 ? 0 : 2);\n"
               "return vec4(sample_texture(quarter, uv).rgb, 1.0);"}}},
            {"texture", {{"image", image}, {"size", 8}}}};
}

TEST(FourTextures, AreAPictureEach) {
    const json names = {"1 0 0", "0 1 0", "leaf", "1 0 0"};
    const auto context = make_context("egl");
    const Spec spec = make_spec(scene_with(names), {"b2f"});
    std::multiset<std::string> asked;
    Stage stage(*context, spec, PixelFormat::rgba8, std::make_unique<PlainPictures>(asked));
    const Image image = stage.picture(spec.methods[0]);
    EXPECT_EQ(asked, (std::multiset<std::string>{"1 0 0", "0 1 0"})) << "each once";
    const float expected[4][3] = {{1, 0, 0}, {0, 1, 0}, {-1, -1, -1}, {1, 0, 0}};
    for (int quarter : {0, 1, 3})
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_EQ(image.pixel(8 + 16 * (quarter % 2), 8 + 16 * (quarter / 2))[channel], expected[quarter][channel])
                << quarter;
    // The third picture is the third variant of the leaves.
    const Spec leaves = make_spec(scene_with("leaf"), {"b2f"});
    Stage painted(*context, leaves, PixelFormat::rgba8);
    const Image leaf = painted.picture(leaves.methods[0]);
    for (int y = 16; y < 32; ++y)
        for (int x = 0; x < 16; ++x)
            for (int channel = 0; channel < 3; ++channel)
                ASSERT_EQ(image.pixel(x, y)[channel], leaf.pixel(x, y)[channel]) << x << ' ' << y;
}

TEST(FourTextures, OfOneNameAreAllThatPicture) {
    const auto context = make_context("egl");
    const Spec spec = make_spec(scene_with("0 0 1"), {"b2f"});
    std::multiset<std::string> asked;
    Stage stage(*context, spec, PixelFormat::rgba8, std::make_unique<PlainPictures>(asked));
    const Image image = stage.picture(spec.methods[0]);
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        ASSERT_EQ(image.rgba[4 * i], 0);
        ASSERT_EQ(image.rgba[4 * i + 2], 1);
    }
    EXPECT_EQ(asked.size(), 1u);
}

TEST(FourTextures, AreEachFoundByTheirField) {
    const Spec spec = make_spec(scene_with({"one.png", "smoke", "two.png", "one.png"}), {"b2f"});
    std::vector<std::string> found;
    for (const AssetReference& reference : scene_assets(spec.scene))
        found.push_back(reference.pointer + " " + reference.name + " " + reference.type);
    EXPECT_EQ(found, (std::vector<std::string>{"/scene/texture/image/0 one.png texture",
                                               "/scene/texture/image/2 two.png texture",
                                               "/scene/texture/image/3 one.png texture"}));
    NoAssets none;
    try {
        build_geometry(spec.scene, spec.image, none);
        FAIL();
    } catch (const SpecError& error) {
        EXPECT_EQ(error.errors().at(0).pointer, "/scene/texture/image/0");
    }
    std::multiset<std::string> asked;
    PlainPictures pictures(asked);
    const Geometry geometry = build_geometry(spec.scene, spec.image, pictures);
    std::vector<std::string> noted;
    for (const Note& note : geometry.notes) noted.push_back(note.where);
    EXPECT_EQ(noted, (std::vector<std::string>{"/scene/texture/image/0", "/scene/texture/image/2"}));
}

TEST(FourTextures, AreOneNameOrFour) {
    const auto wrong = [](const json& image) {
        try {
            make_spec(scene_with(image), {"b2f"});
        } catch (const SpecError& error) {
            EXPECT_EQ(error.errors().size(), 1u);
            return error.errors()[0].pointer + ": " + error.errors()[0].detail;
        }
        return std::string();
    };
    EXPECT_EQ(wrong({"a", "b", "c", "d"}), "");
    const std::string each = "must be one of leaf, smoke, or the SHA-256 of an uploaded texture";
    EXPECT_EQ(wrong({"a", "b", "c"}),
              "/scene/texture/image: " + each + ", or an array of 4 of them, not [\"a\",\"b\",\"c\"]");
    EXPECT_EQ(wrong({"a", "b", 3, "d"}), "/scene/texture/image/2: " + each + ", not 3");
    EXPECT_EQ(wrong({"a", "b", "", "d"}), "/scene/texture/image/2: " + each + ", not \"\"");
    EXPECT_EQ(wrong(7), "/scene/texture/image: " + each + ", or an array of 4 of them, not 7");
}

}  // namespace

}  // namespace sheer::test::textures_test
