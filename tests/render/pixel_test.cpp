// What a pixel is made of: compared with values worked out by hand if the scene is `layers`, and otherwise with the
// exact picture.
#include "renderer/compare/pixel.h"

#include <gmock/gmock.h>

#include "renderer/passes/overdraw.h"
#include "tests/render/render_test.h"

namespace sheer::test::pixel_test {

namespace {

using nlohmann::json;

/// Float colors and weights of some dozens of fragments.
constexpr double float_tolerance = 2e-6;

struct Expected {
    double depth;
    Rgb color;
    double alpha;
    std::uint32_t primitive;
    double transmittance_before, weight;
};

struct Case {
    int x, y;
    std::vector<Expected> fragments;
    bool on_opaque;
    double transmittance;
    Rgb sum;
};

json layer(const json& rect, double depth, const Rgb& color, double alpha, bool opaque = false) {
    return {{"rect", rect}, {"depth", depth}, {"color", color}, {"alpha", alpha}, {"opaque", opaque}};
}

const Rgb red{1, 0, 0}, blue{0, 0, 1}, green{0, 1, 0}, yellow{1, 1, 0}, magenta{1, 0, 1}, background{0.2, 0.4, 0.6};

/// Red at the back, opaque blue in the upper half, green and, at the same depth in the upper half, magenta, and yellow
/// in the left half in front.
json known_layers() {
    return {{"type", "layers"},
            {"layers",
             {layer({0, 0, 1, 1}, 0.8, red, 0.5), layer({0, 0, 1, 0.5}, 0.7, blue, 1, true),
              layer({0, 0, 1, 1}, 0.5, green, 0.5), layer({0, 0, 0.5, 1}, 0.25, yellow, 0.25),
              layer({0, 0, 1, 0.5}, 0.5, magenta, 0.4)}}};
}

void expect_color(const Rgb& color, const Rgb& expected, double tolerance = float_tolerance) {
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(color[i], expected[i], tolerance) << "channel " << i;
}

void expect_fragment(const PixelFragment& fragment, const Expected& expected) {
    EXPECT_NEAR(fragment.depth, expected.depth, float_tolerance);
    expect_color(fragment.color, expected.color);
    EXPECT_NEAR(fragment.alpha, expected.alpha, float_tolerance);
    EXPECT_EQ(fragment.primitive, expected.primitive);
    EXPECT_NEAR(fragment.transmittance_before, expected.transmittance_before, float_tolerance);
    EXPECT_NEAR(fragment.weight, expected.weight, float_tolerance);
}

Rgb pixel_of(const Image& image, int x, int y) {
    const float* pixel = image.pixel(x, y);
    return {pixel[0], pixel[1], pixel[2]};
}

/// The values are worked out by hand: weights are products of 1 - alpha, the sum is of weights times colors.
TEST(Pixel, LayersAreWhatTheirSpecSays) {
    const Case cases[] = {
        // Upper left. Of the two at 0.5 the one submitted later is nearer; red is hidden.
        {1,
         1,
         {{0.25, yellow, 0.25, 3, 1, 0.25}, {0.5, magenta, 0.4, 4, 0.75, 0.3}, {0.5, green, 0.5, 2, 0.45, 0.225}},
         true,
         0.225,
         {0.55, 0.475, 0.525}},
        // Lower left: 0.25 + 0.1875 + 0.1875 * 0.2 of red, and so on.
        {1,
         6,
         {{0.25, yellow, 0.25, 3, 1, 0.25}, {0.5, green, 0.5, 2, 0.75, 0.375}, {0.8, red, 0.5, 0, 0.375, 0.1875}},
         false,
         0.1875,
         {0.475, 0.7, 0.1125}},
        // Lower right.
        {6, 6, {{0.5, green, 0.5, 2, 1, 0.5}, {0.8, red, 0.5, 0, 0.5, 0.25}}, false, 0.25, {0.3, 0.6, 0.15}}};
    const auto context = make_context("egl");
    NoAssets assets;
    for (const std::string format : {"rgba8", "rgba32f"}) {
        const Spec spec = make_spec(known_layers(), {"exact"}, 8, format);
        Stage stage(*context, spec, spec.image.format);
        const Image exact = stage.picture(spec.methods[0]);
        for (const Case& wanted : cases) {
            SCOPED_TRACE(format + " at " + std::to_string(wanted.x) + ", " + std::to_string(wanted.y));
            const PixelStack stack = explain_pixel(spec, *context, assets, wanted.x, wanted.y);
            ASSERT_EQ(stack.fragments.size(), wanted.fragments.size());
            for (std::size_t i = 0; i < wanted.fragments.size(); ++i)
                expect_fragment(stack.fragments[i], wanted.fragments[i]);
            expect_color(stack.background, background);
            ASSERT_EQ(stack.opaque.has_value(), wanted.on_opaque);
            if (stack.opaque) {
                EXPECT_NEAR(stack.opaque->depth, 0.7, float_tolerance);
                expect_color(stack.opaque->color, blue);
            }
            EXPECT_NEAR(stack.transmittance, wanted.transmittance, float_tolerance);
            expect_color(stack.sum, wanted.sum);
            // Opaque colors and the result are each rounded to a level.
            expect_color(pixel_of(exact, wanted.x, wanted.y), wanted.sum, format == "rgba8" ? 1.01 / 255 : 2e-6);
        }
    }
}

TEST(Pixel, APixelWithoutFragmentsIsTheBackground) {
    const auto context = make_context("egl");
    NoAssets assets;
    const Spec spec =
        make_spec({{"type", "layers"}, {"layers", {layer({0, 0, 0.5, 1}, 0.5, red, 0.5)}}}, {"b2f"}, 8, "rgba32f");
    const PixelStack stack = explain_pixel(spec, *context, assets, 7, 0);
    EXPECT_TRUE(stack.fragments.empty());
    EXPECT_EQ(stack.opaque, std::nullopt);
    EXPECT_EQ(stack.transmittance, 1);
    expect_color(stack.sum, background);
}

/// A model: a blended square in front of another and of an opaque one, seen at an angle. A volume: 64 values.
class OwnAssets : public NoAssets {
  public:
    Model model(const std::string&) override {
        Model model;
        model.materials = {{.alpha = Material::Alpha::blend, .base_color = {0.9f, 0.2f, 0.1f, 0.5f}},
                           {.alpha = Material::Alpha::blend, .base_color = {0.1f, 0.8f, 0.3f, 0.25f}},
                           {.alpha = Material::Alpha::opaque, .base_color = {0.2f, 0.3f, 0.9f, 1}}};
        for (std::uint32_t i = 0; i < 3; ++i) {
            ModelPart part;
            part.material = i;
            for (const glm::vec2 corner : {glm::vec2{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
                part.vertices.push_back({{3 * corner.x, 3 * corner.y, 1.5f * corner.x - 2.0f * static_cast<float>(i)},
                                         {0, 0, 1},
                                         corner,
                                         glm::vec4(1)});
            part.indices = {0, 1, 2, 0, 2, 3};
            model.parts.push_back(part);
        }
        return model;
    }
    Volume volume(const std::string&, const VolumeOptions&) override {
        std::vector<std::uint8_t> bytes(64);
        for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i * 37);
        return {.size = {4, 4, 4}, .spacing = glm::dvec3(0.25), .bytes = std::move(bytes), .floats = {}};
    }
};

struct SceneCase {
    std::string name;
    json scene;
    std::size_t least_fragments;  ///< at the middle of the picture
};

/// Scenes whose fragments are not known beforehand: the sum must be what the exact lists give.
TEST(Pixel, TheSumIsTheExactPicture) {
    const json quads = {
        {"type", "quads"}, {"count", 150}, {"shading", "4x4-textures-math"}, {"texture", {{"size", 64}}}};
    const json pane_camera = {{"eye", {0, 0, 10}}, {"target", {0, 0, 0}}, {"fov_y_deg", 60}};
    const json transfer = {{{"value", 0.2}, {"color", {0.9, 0.2, 0.1}}, {"alpha", 0}},
                           {{"value", 0.9}, {"color", {0.1, 0.6, 0.9}}, {"alpha", 0.1}}};
    const SceneCase cases[] = {{"quads", quads, 5},
                               {"particles", {{"type", "particles"}, {"count", 400}, {"texture", {{"size", 64}}}}, 2},
                               {"volume",
                                {{"type", "volume"},
                                 {"slices", 48},
                                 {"volume", {{"data", "by hand"}}},
                                 {"transfer", transfer},
                                 {"frame", false}},
                                20},
                               {"gltf", {{"type", "gltf"}, {"model", "panes"}, {"camera", pane_camera}}, 2}};
    const auto context = make_context("egl");
    constexpr int size_px = 48;
    for (const SceneCase& tried : cases) {
        SCOPED_TRACE(tried.name);
        const Spec spec = make_spec(tried.scene, {{{"id", "exact"}, {"form", "lists"}}}, size_px, "rgba32f");
        OwnAssets assets;
        Stage stage(*context, spec, spec.image.format, std::make_unique<OwnAssets>());
        const Image exact = stage.picture(spec.methods[0]);
        gl::FrameTimer timer(*context);
        gl::FrameTimer::Frame frame = timer.frame(false);
        const PixelCounts overdraw = count_overdraw(context->gl(), stage.scene(), stage.target(), timer);
        frame.end();
        for (const auto& [x, y] : {std::pair{24, 24}, {24, 20}, {10, 30}, {37, 5}, {0, 47}}) {
            SCOPED_TRACE(std::to_string(x) + ", " + std::to_string(y));
            const PixelStack stack = explain_pixel(spec, *context, assets, x, y);
            EXPECT_EQ(stack.fragments.size(), overdraw.counts[static_cast<std::size_t>(y) * size_px + x]);
            if (x == 24 && y == 24) {
                EXPECT_GE(stack.fragments.size(), tried.least_fragments);
            }
            expect_color(stack.sum, pixel_of(exact, x, y), 5e-6);
            EXPECT_TRUE(std::ranges::is_sorted(stack.fragments, {}, &PixelFragment::depth));
        }
    }
}

/// More than are kept without being counted first.
TEST(Pixel, ThousandsOfFragmentsAreAllKept) {
    const auto context = make_context("egl");
    NoAssets assets;
    const Spec spec = make_spec({{"type", "quads"}, {"distribution", "full"}, {"count", 3000}, {"shading", "constant"}},
                                {{{"id", "exact"}, {"form", "lists"}}}, 4, "rgba32f");
    const PixelStack stack = explain_pixel(spec, *context, assets, 2, 1);
    ASSERT_EQ(stack.fragments.size(), 3000u);
    std::vector<std::uint32_t> primitives;
    for (const PixelFragment& fragment : stack.fragments) primitives.push_back(fragment.primitive);
    std::ranges::sort(primitives);
    EXPECT_EQ(std::ranges::unique(primitives).begin(), primitives.end());
    Stage stage(*context, spec, spec.image.format);
    expect_color(stack.sum, pixel_of(stage.picture(spec.methods[0]), 2, 1), 5e-6);
}

/// One triangle over the whole picture, again and again.
class ManyTriangles : public NoAssets {
  public:
    Model model(const std::string&) override {
        Model model;
        model.materials = {{.alpha = Material::Alpha::blend, .base_color = {1, 1, 1, 0.5f}}};
        ModelPart part;
        for (const glm::vec2 corner : {glm::vec2{-90, -90}, {90, -90}, {0, 90}})
            part.vertices.push_back({{corner.x, corner.y, 0}, {0, 0, 1}, {0, 0}, glm::vec4(1)});
        for (std::uint32_t i = 0; i < 3 * (max_pixel_fragments + 1); ++i) part.indices.push_back(i % 3);
        model.parts.push_back(part);
        return model;
    }
};

TEST(Pixel, TooManyFragmentsAreRefused) {
    const auto context = make_context("egl");
    ManyTriangles assets;
    const json camera = {{"eye", {0, 0, 10}}, {"target", {0, 0, 0}}, {"fov_y_deg", 60}};
    const Spec spec = make_spec({{"type", "gltf"}, {"model", "many"}, {"camera", camera}}, {"b2f"}, 1);
    EXPECT_THROW(explain_pixel(spec, *context, assets, 0, 0), Unsupported);
}

}  // namespace

}  // namespace sheer::test::pixel_test
