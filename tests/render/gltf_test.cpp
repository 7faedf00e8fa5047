// Models: opaque, masked and blended surfaces. Each is a square that fills the picture at its depth, so that a `layers`
// scene gives the expected picture; layers_test.cpp compares those with a compositor on the CPU.
#include "renderer/scene/model.h"
#include "tests/render/method_row.h"
#include "tests/render/render_test.h"

namespace sheer::test::gltf_test {

namespace {

constexpr int size_px = 32, texels = 8;

/// Returns one model, whatever the name.
class OneModel : public AssetReader {
  public:
    explicit OneModel(Model model) : m_model(std::move(model)) {}
    Picture picture(const std::string&, int, int) override { throw AssetError("no pictures here"); }
    Volume volume(const std::string&, const VolumeOptions&) override { throw AssetError("no volumes here"); }
    Model model(const std::string&) override { return m_model; }

  private:
    Model m_model;
};

/// Seen from 10 on the z axis under a right angle, a square at z fills the picture.
ModelPart square(float z, std::uint32_t material, const glm::vec2& uv_shift = {0, 0}) {
    ModelPart part;
    part.material = material;
    for (const glm::vec2 corner : {glm::vec2{0, 0}, {1, 0}, {1, 1}, {0, 1}})
        part.vertices.push_back({{(10 - z) * (2 * corner.x - 1), (10 - z) * (1 - 2 * corner.y), z},
                                 {0, 0, 1},
                                 corner + uv_shift,
                                 glm::vec4(1)});
    part.indices = {0, 2, 1, 0, 3, 2};
    return part;
}

bool is_solid(int column, int row) {
    return (column + row) % 2 == 0;
}

/// Every other texel is clear.
Picture checker() {
    Picture picture{Image(texels, texels), true};
    for (int y = 0; y < texels; ++y)
        for (int x = 0; x < texels; ++x) {
            float* texel = picture.image.pixel(x, y);
            texel[0] = 0.2f;
            texel[1] = 0.6f;
            texel[2] = 1;
            texel[3] = is_solid(x, y) ? 1 : 0;
        }
    return picture;
}

const glm::vec4 blue(0.2f, 0.4f, 0.8f, 1), orange(1, 0.5f, 0, 0.5f), green(0.1f, 0.9f, 0.3f, 0.25f);

/// Two that blend, the nearer one first, in front of an opaque one.
Model glass() {
    Model model;
    model.materials = {{.alpha = Material::Alpha::blend, .base_color = green},
                       {.alpha = Material::Alpha::blend, .base_color = orange},
                       {.alpha = Material::Alpha::opaque, .base_color = blue}};
    model.parts = {square(2, 0), square(1, 1), square(0, 2)};
    return model;
}

/// The checker, nearest, in front of one that blends and an opaque one. Negative texture coordinates repeat the
/// picture.
Model grid() {
    Model model = glass();
    model.materials[0] = {
        .alpha = Material::Alpha::mask, .cutoff = 0.5f, .base_color = {1, 0.5f, 1, 1}, .base = {.picture = 0}};
    model.parts[0] = square(2, 0, {-3, -1});
    model.pictures = {checker()};
    return model;
}

nlohmann::json layer(const glm::vec4& color, double depth, bool opaque, const nlohmann::json& rect = {-1, -1, 2, 2}) {
    return {{"rect", rect},
            {"depth", depth},
            {"color", {color.r, color.g, color.b}},
            {"alpha", color.a},
            {"opaque", opaque}};
}

nlohmann::json glass_layers() {
    return {{"type", "layers"},
            {"layers", {layer(green, 0.3, false), layer(orange, 0.5, false), layer(blue, 0.7, true)}}};
}

nlohmann::json grid_layers() {
    nlohmann::json layers = {layer(orange, 0.5, false), layer(blue, 0.7, true)};
    for (int y = 0; y < texels; ++y)
        for (int x = 0; x < texels; ++x)
            if (is_solid(x, y))
                layers.push_back(
                    layer({0.2f, 0.3f, 1, 1}, 0.3, true,
                          {double(x) / texels, double(y) / texels, double(x + 1) / texels, double(y + 1) / texels}));
    return {{"type", "layers"}, {"layers", layers}};
}

nlohmann::json model_scene(const std::string& light = "none", const std::string& shading = "material") {
    return {{"type", "gltf"},
            {"model", "the one"},
            {"light", light},
            {"shading", shading},
            {"texture", {{"size", 16}}},
            {"camera", {{"eye", {0, 0, 10}}, {"target", {0, 0, 0}}, {"fov_y_deg", 90}}}};
}

/// The spec's scene is a model.
Stage model_stage(gl::Context& context, const Spec& spec, const Model& model) {
    OneModel assets(model);
    return Stage(context, spec, spec.image.format, build_geometry(spec.scene, spec.image, assets));
}

class Gltf : public testing::TestWithParam<std::string> {};

/// Sampled at an eighth and three eighths of a texel off its middle, the checker's alpha stays on its side of 0.5.
/// The layers are at other depths, in the same order.
TEST_P(Gltf, EveryMethodDrawsItLikeLayers) {
    const auto context = make_context(GetParam());
    nlohmann::json methods = nlohmann::json::array();
    for (const MethodRow& row : all_method_rows())
        if (!row.weighs_depths && !row.noise) methods.push_back(row.id);
    const std::pair<Model, nlohmann::json> cases[] = {{glass(), glass_layers()}, {grid(), grid_layers()}};
    for (const auto& [model, layers] : cases) {
        const Spec spec = make_spec(model_scene(), methods, size_px), flat = make_spec(layers, methods, size_px);
        Stage stage = model_stage(*context, spec, model);
        Stage flat_stage(*context, flat, flat.image.format);
        for (std::size_t i = 0; i < spec.methods.size(); ++i) {
            SCOPED_TRACE(spec.methods[i].id);
            try {
                // A level may be rounded differently when a triangle's color is interpolated.
                EXPECT_LE(greatest_difference(stage.picture(spec.methods[i]), flat_stage.picture(flat.methods[i])),
                          1.01 / 255);
            } catch (const Unsupported&) {
                // A device may lack something that a method needs; the report says so.
            }
        }
    }
}

/// Worked out by hand: blue under half of orange under a quarter of green.
TEST_P(Gltf, BlendsByHand) {
    const auto context = make_context(GetParam());
    const Spec spec = make_spec(model_scene(), {"b2f", "f2b", "exact", "depth_peeling"}, size_px, "rgba32f");
    Stage stage = model_stage(*context, spec, glass());
    for (const MethodSpec& method : spec.methods) {
        const Image image = stage.picture(method);
        for (int i = 0; i < size_px; ++i) {
            EXPECT_NEAR(image.pixel(i, i)[0], 0.75 * 0.6 + 0.25 * 0.1, 1e-5) << method.id;
            EXPECT_NEAR(image.pixel(i, i)[1], 0.75 * 0.45 + 0.25 * 0.9, 1e-5) << method.id;
            EXPECT_NEAR(image.pixel(i, i)[2], 0.75 * 0.4 + 0.25 * 0.3, 1e-5) << method.id;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, Gltf, testing::Values("egl", "osmesa"),
                         [](const testing::TestParamInfo<std::string>& context) { return context.param; });

/// Color and alpha of a picture that blends: texels hold 0.2, 0.6, 1 and alpha 1 or 0; the base color has alpha 0.5.
TEST(GltfPictures, AreMultipliedWithTheTint) {
    const auto context = make_context("egl");
    Model model = grid();
    model.materials[0].alpha = Material::Alpha::blend;
    model.materials[0].base_color.a = 0.5f;
    model.parts.erase(model.parts.begin() + 1);
    const Spec spec = make_spec(model_scene(), {"exact"}, size_px * 3, "rgba32f");
    Stage stage = model_stage(*context, spec, model);
    const Image image = stage.picture(spec.methods[0]);
    // 12 pixels a texel of 8: with an odd number of them the middle one would show the texel alone; here the four about
    // the middle have (1 - 1/24)^2 + 1/24^2 of their own kind's alpha.
    const double own = 23.0 / 24 * 23 / 24 + 1.0 / 24 / 24;
    for (int y = 0; y < texels; ++y)
        for (int x = 0; x < texels; ++x) {
            const double alpha = 0.5 * (is_solid(x, y) ? own : 1 - own);
            const float* pixel = image.pixel(12 * x + 6, 12 * y + 5);
            EXPECT_NEAR(pixel[0], (1 - alpha) * 0.2 + alpha * 0.2, 2e-3);
            EXPECT_NEAR(pixel[1], (1 - alpha) * 0.4 + alpha * 0.3, 2e-3);
            EXPECT_NEAR(pixel[2], (1 - alpha) * 0.8 + alpha * 1.0, 2e-3);
        }
}

/// From far away only a picture's mean is visible: alpha 0.5 everywhere, so a cutoff of 0.6 hides the mask and 0.4
/// shows all of it.
TEST(GltfPictures, AreFilteredFarOff) {
    const auto context = make_context("egl");
    for (const float cutoff : {0.4f, 0.6f}) {
        Model model = grid();
        model.materials[0].cutoff = cutoff;
        model.parts.erase(model.parts.begin() + 1);
        for (ModelVertex& vertex : model.parts[0].vertices) vertex.uv *= 32;
        const Spec spec = make_spec(model_scene(), {"b2f"}, size_px, "rgba32f");
        Stage stage = model_stage(*context, spec, model);
        const Image image = stage.picture(spec.methods[0]);
        for (int i = 0; i < size_px; ++i) EXPECT_NEAR(image.pixel(i, i)[1], cutoff < 0.5f ? 0.3 : 0.4, 1e-5);
    }
}

/// A surface whose alpha equals the cutoff is drawn as if it were opaque, from any view.
TEST(GltfMasks, AtTheirCutoffAreWhole) {
    const auto context = make_context("egl");
    for (const float alpha : {0.1f, 0.3f, 0.5f, 0.7f, 0.9f, 1.0f})
        for (const glm::vec3 eye : {glm::vec3{0, 0, 30}, {25, 7, 9}, {-14, 21, 5}}) {
            nlohmann::json scene = model_scene();
            scene["camera"]["eye"] = {eye.x, eye.y, eye.z};
            const Spec spec = make_spec(scene, {"b2f"}, 64, "rgba32f");
            const auto picture = [&](Material::Alpha kind, float vertices) {
                Model model;
                model.materials = {{.alpha = kind, .cutoff = alpha, .base_color = {1, 0, 0, alpha / vertices}}};
                model.parts = {square(0, 0)};
                for (ModelVertex& vertex : model.parts[0].vertices) vertex.color.a = vertices;
                return model_stage(*context, spec, model).picture(spec.methods[0]);
            };
            const Image opaque = picture(Material::Alpha::opaque, 1);
            EXPECT_GT(opaque.pixel(32, 32)[0], 0.9);
            EXPECT_EQ(picture(Material::Alpha::mask, 1).rgba, opaque.rgba) << alpha;
            EXPECT_EQ(picture(Material::Alpha::mask, std::sqrt(alpha)).rgba, opaque.rgba) << alpha;
        }
}

/// With the leaf's holes, the mask's cutoff shows what is behind; without texture reads only the tint is tested.
TEST(GltfShadings, OthersWorkWithTheTint) {
    const auto context = make_context("egl");
    for (const std::string shading : {"constant", "1-texture", "4x4-textures-math"}) {
        const Spec spec = make_spec(model_scene("none", shading), {"b2f"}, size_px, "rgba32f");
        Stage stage = model_stage(*context, spec, grid());
        const Image image = stage.picture(spec.methods[0]);
        std::size_t masked = 0;
        for (int y = 0; y < size_px; ++y)
            for (int x = 0; x < size_px; ++x) masked += std::abs(image.pixel(x, y)[1] - 0.5f) < 1e-5;
        const std::size_t all = std::size_t(size_px) * size_px;
        EXPECT_EQ(masked == all, shading == "constant") << shading;
    }
}

}  // namespace

}  // namespace sheer::test::gltf_test
