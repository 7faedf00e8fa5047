// How methods explain a pixel: the facts must agree with the composite in double precision, and the pixel's value must
// follow from them.
#include <gmock/gmock.h>

#include <set>

#include "renderer/compare/pixel.h"
#include "tests/render/render_test.h"

namespace sheer::test::explanation_test {

namespace {

using nlohmann::json;

constexpr int size_px = 8;
constexpr double tolerance = 3e-6;
const Rgb sky{0.2, 0.4, 0.6};  // of make_spec

struct Layer {
    double depth, alpha;
};

Rgb color_of(const Layer& layer) {
    return {layer.depth, 1 - layer.depth, 0.5};
}

json scene_of(const std::vector<Layer>& layers) {
    json array = json::array();
    for (const Layer& layer : layers)
        array.push_back(
            {{"rect", {0, 0, 1, 1}}, {"depth", layer.depth}, {"color", color_of(layer)}, {"alpha", layer.alpha}});
    return {{"type", "layers"}, {"layers", array}};
}

/// As submitted; from near to far they have the numbers 3, 1, 4 and 2.
const std::vector<Layer> four = {{0.6, 0.25}, {0.2, 0.5}, {0.8, 0.9}, {0.4, 0.75}};
/// From near to far.
const std::vector<Layer> with_cores = {{0.1, 0.5}, {0.2, 0}, {0.3, 1}, {0.4, 0.4}, {0.5, 1}};

/// The facts of one method, by name.
class Explained {
  public:
    Explained(const std::vector<Layer>& layers, const json& method, const std::string& format = "rgba32f") {
        const auto context = make_context("egl");
        NoAssets assets;
        const Spec spec = make_spec(scene_of(layers), json::array({method}), size_px, format);
        m_explanation = explain_pixel(spec, *context, assets, 5, 2).methods.at(0);
        EXPECT_EQ(m_explanation.reason, "");
    }

    json operator[](const std::string& name) const {
        for (const PixelFact& fact : m_explanation.facts)
            if (fact.name == name) return fact.value;
        ADD_FAILURE() << "there is no " << name;
        return {};
    }
    Rgb value() const { return m_explanation.value.value(); }

  private:
    Explanation m_explanation;
};

void expect_near(const json& color, const Rgb& expected, double within = tolerance) {
    ASSERT_EQ(color.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(color[i].get<double>(), expected[i], within) << "channel " << i;
}

/// `front` + `weight` times `behind`.
Rgb over(const Rgb& front, double weight, const Rgb& behind) {
    Rgb sum;
    for (std::size_t i = 0; i < 3; ++i) sum[i] = front[i] + weight * behind[i];
    return sum;
}

Rgb rgb(const json& color) {
    return color.get<Rgb>();
}

TEST(Explanation, BlendingTellsItsOrder) {
    EXPECT_EQ(Explained(four, {{"id", "unsorted"}})["blended"], json({3, 1, 4, 2}));
    EXPECT_EQ(Explained(four, {{"id", "b2f"}})["blended"], json({4, 3, 2, 1}));
    const Explained f2b(four, {{"id", "f2b"}});
    EXPECT_EQ(f2b["blended"], json({1, 2, 3, 4}));
    EXPECT_NEAR(f2b["transmittance"].get<double>(), 0.5 * 0.25 * 0.75 * 0.1, tolerance);
    expect_near(f2b.value(), over(rgb(f2b["accumulated"]), f2b["transmittance"], sky));
}

/// What is left: 0.5, then 0.125.
TEST(Explanation, DiscardingTellsWhereItSaturated) {
    const Explained f2bd(four, {{"id", "f2bd"}, {"threshold", 0.2}, {"batch", 1}});
    EXPECT_EQ(f2bd["blended"], json({1, 2}));
    EXPECT_EQ(f2bd["discarded"], json({3, 4}));
    EXPECT_EQ(f2bd["saturated_at"], 2);
    EXPECT_NEAR(f2bd["transmittance"].get<double>(), 0.125, tolerance);
    const Explained all(four, {{"id", "f2bd"}, {"threshold", 0}});
    EXPECT_EQ(all["saturated_at"], json());
    EXPECT_EQ(all["discarded"], json::array());
    const Explained none(four, {{"id", "f2bx"}});
    EXPECT_EQ(none["discarded"], json({1, 2, 3, 4}));
    EXPECT_EQ(none["saturated_at"], json());
}

TEST(Explanation, DepthMarksTellWhatCameBeforeTheMark) {
    const auto marks = [](int interval) {
        return Explained(four, {{"id", "depth_marks"}, {"threshold", 0.2}, {"interval", interval}});
    };
    EXPECT_EQ(marks(1)["blended"], json({1, 2}));
    EXPECT_EQ(marks(1)["marked_before"], 3);
    EXPECT_EQ(marks(3)["blended"], json({1, 2, 3})) << "the third is shaded in vain";
    EXPECT_EQ(marks(3)["rejected"], json({4}));
    EXPECT_EQ(marks(4)["marked_before"], json());
}

TEST(Explanation, AnAlphaTestTellsWhatIsShown) {
    const Explained test(four, {{"id", "alpha_test"}, {"reference", 0.6}});
    EXPECT_EQ(test["drawn"], json({4, 2}));
    EXPECT_EQ(test["dropped"], json({1, 3}));
    EXPECT_EQ(test["shown"], 2);
    expect_near(test.value(), color_of(four[3]));
    EXPECT_EQ(Explained(four, {{"id", "alpha_test"}, {"reference", 0.95}})["shown"], json());
}

TEST(Explanation, MeshkinsSumsGiveThePixel) {
    const std::vector<Layer> faint = {{0.3, 0.125}, {0.5, 0.25}, {0.7, 0.0625}, {0.1, 0}};
    double alphas = 0, reciprocals = 0, product = 1;
    Rgb colors{};
    for (const Layer& layer : faint) {
        if (layer.alpha == 0) continue;
        alphas += layer.alpha;
        reciprocals += 1 / layer.alpha;
        product *= layer.alpha;
        colors = over(colors, layer.alpha, color_of(layer));
    }
    for (const std::string variant : {"simple", "full"}) {
        SCOPED_TRACE(variant);
        const Explained meshkin(faint, {{"id", "meshkin"}, {"variant", variant}});
        expect_near(meshkin["color_sum"], colors);
        EXPECT_NEAR(meshkin["alpha_sum"].get<double>(), alphas, tolerance);
        double weight = 1 - alphas;
        if (variant == "full") {
            EXPECT_NEAR(meshkin["alpha_product"].get<double>(), product, tolerance);
            EXPECT_NEAR(meshkin["reciprocal_sum"].get<double>(), reciprocals, 1e-5);
            weight += product - reciprocals * product;
        }
        EXPECT_NEAR(meshkin["opaque_weight"].get<double>(), weight, tolerance);
        expect_near(meshkin.value(), over(rgb(meshkin["color_sum"]), meshkin["opaque_weight"], sky));
    }
    EXPECT_EQ(Explained({{0.5, 0}}, {{"id", "meshkin"}})["opaque_weight"], 1.0) << "nothing is summed";
}

/// The greatest alpha is 0.9, their sum 2.4 counts as 1, so that the mask is 0.15 * 0.9 + 0.85.
TEST(Explanation, TheMasksGiveTheBlend) {
    const Explained ssam(four, {{"id", "ssam"}, {"alpha_reference", 0.6}});
    EXPECT_EQ(ssam["chosen"], 2);
    expect_near(ssam["color"], color_of(four[3]));
    EXPECT_NEAR(ssam["mask_maximum"].get<double>(), 0.9, tolerance);
    EXPECT_NEAR(ssam["mask_sum"].get<double>(), 2.4, tolerance);
    const double blend = 0.985 * 0.985;
    EXPECT_NEAR(ssam["blend"].get<double>(), blend, tolerance);
    expect_near(ssam.value(), over(over({}, blend, rgb(ssam["color"])), 1 - blend, sky));
    const Explained max(four, {{"id", "ssam"}, {"alpha_reference", 0.95}, {"mask", "max"}, {"squared", false}});
    EXPECT_EQ(max["chosen"], json());
    expect_near(max["color"], {0, 0, 0});
    EXPECT_NEAR(max["blend"].get<double>(), 0.9, tolerance);
}

/// In the first frame the sky is visible behind the cap; the second frame has the first one's picture there.
TEST(Explanation, ACapTellsWhatItCutAndWhatFilledIt) {
    const Explained cap(four, {{"id", "stencil_cap"}, {"layers", 2}, {"min_alpha", 0.3}, {"frames", 2}});
    EXPECT_EQ(cap["let_through"], json({1, 2}));
    EXPECT_EQ(cap["dropped"], json::array());
    EXPECT_EQ(cap["cut"], json({3, 4}));
    const Rgb two = over(over({}, 0.5, color_of(four[1])), 0.5 * 0.75, color_of(four[3]));
    expect_near(cap["accumulated"], two);
    EXPECT_NEAR(cap["transmittance"].get<double>(), 0.125, tolerance);
    expect_near(cap["fill"], over(two, 0.125, sky));
    expect_near(cap.value(), over(two, 0.125, rgb(cap["fill"])));
    const Explained faint(four, {{"id", "stencil_cap"}, {"layers", 3}, {"min_alpha", 0.6}, {"frames", 1}});
    EXPECT_EQ(faint["let_through"], json({2, 4}));
    EXPECT_EQ(faint["dropped"], json({1, 3}));
    EXPECT_EQ(faint["cut"], json::array());
}

TEST(Explanation, OpaqueDepthTellsWhatClosedThePixel) {
    for (const std::string variant : {"shader_depth", "target_alpha", "two_pass"}) {
        for (const int batch : {0, 2}) {
            SCOPED_TRACE(variant + " " + std::to_string(batch));
            const json method = {{"id", "opaque_depth"}, {"variant", variant}, {"batch", batch}};
            const Explained closed(with_cores, method);
            EXPECT_EQ(closed["closed_by"], 3);
            EXPECT_EQ(closed["blended"], json({1, 3}));
            EXPECT_EQ(closed["dropped"], json({2}));
            EXPECT_EQ(closed["behind"], json({4, 5}));
            expect_near(closed.value(), over(over({}, 0.5, color_of(with_cores[0])), 0.5, color_of(with_cores[2])));
            const Explained open({{0.1, 0.5}, {0.2, 0.25}}, method);
            EXPECT_EQ(open["closed_by"], json());
            EXPECT_EQ(open["blended"], json({1, 2}));
            EXPECT_NEAR(open["transmittance"].get<double>(), 0.375, tolerance);
        }
    }
}

/// The device decides which samples an alpha covers; at 1 all, at 0 none, and the mean is the pixel.
TEST(Explanation, TheMeanOfTheSamplesIsThePixel) {
    const auto explained = [](const std::vector<Layer>& layers) {
        return Explained(layers, {{"id", "alpha_to_coverage"}});
    };
    const Explained coverage = explained(four);
    const json samples = coverage["samples"];
    ASSERT_EQ(samples.size(), 4u);
    const Layer near_to_far[] = {four[1], four[3], four[0], four[2]};
    Rgb mean{};
    for (const json& sample : samples) {
        const json& number = sample["fragment"];
        expect_near(sample["color"], number.is_null() ? sky : color_of(near_to_far[number.get<std::size_t>() - 1]));
        mean = over(mean, 0.25, rgb(sample["color"]));
    }
    expect_near(coverage.value(), mean);
    const json full = explained({{0.5, 1}, {0.7, 1}})["samples"], none = explained({{0.5, 0}})["samples"];
    for (const json& sample : full) EXPECT_EQ(sample["fragment"], 1);
    for (const json& sample : none) EXPECT_EQ(sample["fragment"], json());
}

/// Only one pixel is drawn for an explanation, and its fragments one by one; it must be the pixel of a whole frame.
TEST(Explanation, IsOfThePixelThatAWholeFrameHas) {
    const json scenes[] = {{{"type", "quads"}, {"count", 60}, {"shading", "4x4-textures"}, {"texture", {{"size", 64}}}},
                           {{"type", "foliage"}, {"trees", 2}, {"shading", "1-texture"}, {"texture", {{"size", 64}}}}};
    json methods =
        json::array({{{"id", "stencil_cap"}, {"layers", 3}, {"zcull", true}, {"frames", 4}, {"label", "zcull"}},
                     {{"id", "ssam"}, {"opaque_msaa", 2}, {"label", "msaa"}},
                     {{"id", "exact"}, {"form", "lists"}, {"memory_mib", 1}, {"label", "lists"}}});
    for (const MethodInfo& method : all_methods()) methods.push_back(method.id);
    const auto context = make_context("egl");
    NoAssets assets;
    for (const json& scene : scenes) {
        const Spec spec = make_spec(scene, methods, 40);
        Stage stage(*context, spec, spec.image.format);
        std::vector<Image> pictures;
        for (const MethodSpec& method : spec.methods) {
            try {
                pictures.push_back(stage.picture(method));
            } catch (const Unsupported&) {
                pictures.emplace_back();
            }
        }
        for (const auto& [x, y] : {std::pair{20, 20}, {13, 30}, {39, 7}}) {
            const PixelStack stack = explain_pixel(spec, *context, assets, x, y);
            for (std::size_t i = 0; i < spec.methods.size(); ++i) {
                SCOPED_TRACE(spec.methods[i].label + " " + std::to_string(x) + ", " + std::to_string(y));
                ASSERT_EQ(stack.methods[i].value.has_value(), !pictures[i].rgba.empty()) << stack.methods[i].reason;
                if (!stack.methods[i].value) continue;
                const float* pixel = pictures[i].pixel(x, y);
                for (std::size_t channel = 0; channel < 3; ++channel)
                    EXPECT_NEAR((*stack.methods[i].value)[channel], pixel[channel], 1e-6);
                std::set<std::string> names;
                for (const PixelFact& fact : stack.methods[i].facts) {
                    EXPECT_TRUE(names.insert(fact.name).second) << fact.name << " is there twice";
                    EXPECT_THAT(fact.text, testing::EndsWith(".")) << fact.name;
                }
            }
        }
    }
}

TEST(Explanation, OfWhatCannotRunHasAReason) {
    const auto context = make_context("egl");
    NoAssets assets;
    const Spec spec = make_spec(
        {{"type", "quads"}, {"distribution", "full"}, {"count", max_explained_fragments + 1}, {"shading", "constant"}},
        {"b2f"}, 2);
    const PixelStack stack = explain_pixel(spec, *context, assets, 0, 0);
    EXPECT_EQ(stack.methods[0].value, std::nullopt);
    EXPECT_THAT(stack.methods[0].reason, testing::HasSubstr("5001 fragments"));
}

}  // namespace

}  // namespace sheer::test::explanation_test
