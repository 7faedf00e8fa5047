// Screen-space alpha masking compared with layers worked out by hand, one parameter after the other.
#include <cmath>

#include "renderer/core/random.h"
#include "tests/render/render_test.h"

namespace sheer::test::ssam_test {

namespace {

using nlohmann::json;
using Color = std::array<double, 3>;

constexpr Color below = {0.2, 0.4, 0.6};  // the background of make_spec
constexpr Color near_color = {0.9, 0.1, 0.3}, far_color = {0.1, 0.8, 0.5}, clear_color = {0.7, 0.2, 1};

json layer(double depth, const Color& color, double alpha, bool opaque = false) {
    return {{"rect", {0, 0, 1, 1}}, {"depth", depth}, {"color", color}, {"alpha", alpha}, {"opaque", opaque}};
}

/// Alpha 0.3 in front of 0.6: the greatest is 0.6, the sum 0.9, and at 0.85 their mix 0.855.
const json& two_layers() {
    static const json layers = {layer(0.2, near_color, 0.3), layer(0.6, far_color, 0.6)};
    return layers;
}

json ssam(json parameters = json::object()) {
    parameters["id"] = "ssam";
    return parameters;
}

class Ssam : public testing::Test {
  protected:
    Image picture(const json& layers, const json& method, const std::string& format = "rgba32f", int size_px = 4) {
        const Spec spec = make_spec({{"type", "layers"}, {"layers", layers}}, json::array({method}), size_px, format);
        Stage stage(*m_context, spec, spec.image.format);
        return stage.picture(spec.methods[0]);
    }
    gl::Context& context() { return *m_context; }

  private:
    std::unique_ptr<gl::Context> m_context = make_context("egl");
};

void expect_mix(const Image& image, const Color& a, const Color& b, double weight_of_b, double tolerance,
                const std::string& what) {
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(image.pixel(1, 2)[i], (1 - weight_of_b) * a[i] + weight_of_b * b[i], tolerance) << what << ' ' << i;
}

TEST_F(Ssam, EachParameter) {
    struct Row {
        json parameters;
        Color foliage;
        double weight;
    };
    const std::vector<Row> rows = {
        {json::object(), near_color, 0.855 * 0.855},
        {{{"squared", false}}, near_color, 0.855},
        {{{"mask_lerp", 0}}, near_color, 0.6 * 0.6},
        {{{"mask_lerp", 1}}, near_color, 0.9 * 0.9},
        {{{"mask_lerp", 0.5}}, near_color, 0.75 * 0.75},
        {{{"mask", "max"}}, near_color, 0.6 * 0.6},
        {{{"mask", "additive"}}, near_color, 0.9 * 0.9},
        {{{"mask", "max"}, {"mask_lerp", 1}, {"squared", false}}, near_color, 0.6},
        {{{"mask", "additive"}, {"mask_lerp", 0}, {"squared", false}}, near_color, 0.9},
        {{{"alpha_reference", 0}}, near_color, 0.855 * 0.855},
        // Too faint for the color pass, the near layer still counts in the mask.
        {{{"alpha_reference", 0.5}}, far_color, 0.855 * 0.855},
        {{{"alpha_reference", 0.7}}, {0, 0, 0}, 0.855 * 0.855},
        {{{"alpha_reference", 0.7}, {"clear_color", clear_color}}, clear_color, 0.855 * 0.855},
        {{{"opaque_msaa", 2}}, near_color, 0.855 * 0.855},
    };
    for (const Row& row : rows) {
        const json method = ssam(row.parameters);
        expect_mix(picture(two_layers(), method), below, row.foliage, row.weight, 2e-6, method.dump());
        // Masks to half a level each, squared: a level; the two pictures and the result half a level each.
        expect_mix(picture(two_layers(), method, "rgba8"), below, row.foliage, row.weight, 2.5 / 255, method.dump());
    }
}

/// 0.3 + 0.6 + 0.7 saturates at 1, in float targets too, and in any order: with the maximum 0.7 the mix is 0.955.
TEST_F(Ssam, AdditiveMaskSaturates) {
    json layers = two_layers();
    layers.push_back(layer(0.4, {1, 1, 1}, 0.7));
    for (const std::string format : {"rgba8", "rgba16f", "rgba32f"}) {
        expect_mix(picture(layers, ssam({{"mask", "additive"}}), format), below, near_color, 1, 0.5 / 255 + 1e-6,
                   format);
        expect_mix(picture(layers, ssam({{"squared", false}}), format), below, near_color, 0.955, 2.5 / 255, format);
    }
}

TEST_F(Ssam, AlphaZeroAndOne) {
    expect_mix(picture(json::array({layer(0.5, near_color, 0)}), ssam({{"clear_color", clear_color}})), below, below, 0,
               1e-6, "0");
    expect_mix(picture(json::array({layer(0.5, near_color, 1)}), ssam()), below, near_color, 1, 1e-6, "1");
}

/// The theory for glass: a red layer of 0.5 in front of an opaque green one is 0.75 of green, since the mask is
/// squared, and the farther of two layers contributes no color at all.
TEST_F(Ssam, OnlyTheNearestColorShows) {
    const json glass = {layer(0.9, {0, 1, 0}, 1, true), layer(0.3, {1, 0, 0}, 0.5)};
    expect_mix(picture(glass, ssam()), {0, 1, 0}, {1, 0, 0}, 0.25, 1e-6, "one");
    json covered = glass;
    covered.push_back(layer(0.6, {0, 0, 1}, 0.5));
    EXPECT_EQ(picture(covered, ssam()).pixel(1, 1)[2], 0);
}

/// In both mask and color, opaque geometry hides exactly what is behind it.
TEST_F(Ssam, OpaqueInFrontBehindBetween) {
    for (const int samples : {1, 2}) {
        const json method = ssam({{"opaque_msaa", samples}});
        json layers = two_layers();
        layers.push_back(layer(0.1, {0, 1, 1}, 1, true));
        expect_mix(picture(layers, method), {0, 1, 1}, {}, 0, 1e-6, "in front");
        layers.back() = layer(0.8, {0, 1, 1}, 1, true);
        expect_mix(picture(layers, method), {0, 1, 1}, near_color, 0.855 * 0.855, 2e-6, "behind");
        // Only the near layer is left: maximum and sum are 0.3.
        layers.back() = layer(0.4, {0, 1, 1}, 1, true);
        expect_mix(picture(layers, method), {0, 1, 1}, near_color, 0.09, 2e-6, "between");
    }
}

/// An opaque edge at 3.45 pixels covers half the samples of pixel 3 (at 2 and at 4 per pixel) and not its middle. Its
/// color is the mean; its depth the nearest, which hides the foliage behind it from the whole pixel.
TEST_F(Ssam, OpaqueSamplesAreResolved) {
    json layers = {layer(0.3, {1, 1, 1}, 1, true), layer(0.5, {0, 0, 0}, 1)};
    layers[0]["rect"] = {0, 0, 3.45 / 8, 1};
    const auto red = [&](int samples, int x) {
        return picture(layers, ssam({{"opaque_msaa", samples}}), "rgba32f", 8).pixel(x, 4)[0];
    };
    EXPECT_EQ(red(1, 2), 1);
    EXPECT_EQ(red(1, 3), 0) << "the foliage";
    EXPECT_EQ(red(2, 2), 1);
    EXPECT_NEAR(red(2, 3), 0.5 * 1 + 0.5 * below[0], 1e-6);
    EXPECT_EQ(red(2, 4), 0);
}

/// With distinct depths, every order of submission gives the same picture; in 8 bits, to the last bit.
TEST_F(Ssam, SubmissionDoesNotMatter) {
    json layers = two_layers();
    layers.push_back(layer(0.4, {0.4, 0.9, 0.9}, 0.28));
    layers.push_back(layer(0.1, {0.6, 0.6, 0.1}, 0.05));
    std::vector<json> order(layers.begin(), layers.end());
    std::ranges::sort(order);
    const Image expected = picture(layers, ssam(), "rgba8");
    const Image expected_float = picture(layers, ssam({{"mask_lerp", 0.3}}));
    int orders = 0;
    do {
        EXPECT_EQ(greatest_difference(picture(order, ssam(), "rgba8"), expected), 0) << order;
        EXPECT_LE(greatest_difference(picture(order, ssam({{"mask_lerp", 0.3}})), expected_float), 1e-6) << order;
        ++orders;
    } while (std::ranges::next_permutation(order).found);
    EXPECT_EQ(orders, 24);
}

/// The color pass leaves its depths in the target; the next frame must start from the opaque ones.
/// Intersecting planes in another order of submission: the same picture to the last bit.
TEST_F(Ssam, FoliageDoesNotDependOnSubmission) {
    const Spec spec =
        make_spec({{"type", "foliage"}, {"trees", 2}, {"planes_per_tree", 40}, {"texture", {{"size", 64}}}},
                  json::array({"ssam", "unsorted"}), 96);
    NoAssets assets;
    Geometry geometry = build_geometry(spec.scene, spec.image, assets);
    std::array<Image, 2> in_order, shuffled;
    const auto render = [&](std::array<Image, 2>& pictures) {
        Stage stage(context(), spec, spec.image.format, geometry);
        for (std::size_t i = 0; i < 2; ++i) pictures[i] = stage.picture(spec.methods[i]);
    };
    render(in_order);
    Random random(5);
    for (std::size_t i = geometry.primitives.size(); i > 1; --i)
        std::swap(geometry.primitives[i - 1], geometry.primitives[random.below(i)]);
    render(shuffled);
    EXPECT_EQ(in_order[0].rgba, shuffled[0].rgba);
    EXPECT_NE(in_order[1].rgba, shuffled[1].rgba) << "the order does matter to blending";
}

TEST_F(Ssam, FramesDoNotDependOnEachOther) {
    const Spec spec = make_spec({{"type", "layers"}, {"layers", two_layers()}},
                                {ssam(), ssam({{"opaque_msaa", 2}, {"label", "2"}}), "b2f"}, 4);
    Stage stage(context(), spec, PixelFormat::rgba8);
    for (std::size_t i = 0; i < 2; ++i) {
        const auto method = stage.make(spec.methods[i]);
        stage.frame(*method);
        const Image first = stage.target().read();
        stage.picture(spec.methods[2]);
        stage.frame(*method);
        EXPECT_EQ(greatest_difference(stage.target().read(), first), 0) << i;
    }
    EXPECT_EQ(stage.make(spec.methods[0])->memory_bytes(), 4 * 4 * 2 * 4);
    EXPECT_GE(stage.make(spec.methods[1])->memory_bytes(), 4 * 4 * (2 * 4 + 2 * 8));
}

}  // namespace

}  // namespace sheer::test::ssam_test
