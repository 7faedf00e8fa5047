// Litmus scenes: every method on each of them, with the outcome that its theory predicts. The rows are those of
// litmus.json beside this file, which docs/litmus.md is made from.
#include <cmath>
#include <fstream>

#include "tests/render/litmus_scenes.h"
#include "tests/render/render_test.h"

namespace sheer::test::litmus_test {

namespace {

using nlohmann::json;
using Order = Compositor::Order;

constexpr double passes_within = 3.0 / 255, fails_from = 6.0 / 255;

const json& litmus() {
    static const json read = json::parse(std::ifstream(SHEER_SOURCE_DIR "/tests/render/litmus.json"));
    return read;
}

/// How much a picture in 32-bit floats may be off the formula: the roundings of up to 64 layers; and for the methods
/// with a threshold of 0.01 what they may leave out.
double formula_tolerance(const std::string& id) {
    return id == "f2bd" || id == "depth_marks" ? 0.01 : 64e-5;
}

/// Front to back up to the cap of 8, without what is under min_alpha. Full pixels see the previous frame behind: in an
/// even picture P(n) = A + T P(n - 1), with P(1) = A + T D.
Compositor::Color stencil_cap(Compositor::Stack stack, int frames) {
    constexpr std::size_t cap = 8;
    std::erase_if(stack.fragments, [](const auto& fragment) { return fragment.alpha < 0.02; });
    std::ranges::stable_sort(stack.fragments, std::greater(), &Compositor::Fragment::depth);
    if (stack.fragments.size() <= cap) return Compositor::over(stack);
    stack.fragments.erase(stack.fragments.begin(), stack.fragments.end() - cap);
    for (int frame = 1; frame < frames; ++frame) stack.below = Compositor::over(stack);
    return Compositor::over(stack);
}

/// What theory says that this method makes of the scene; nothing where the formula is that of one driver.
std::optional<Compositor::Color> predicted(const json& method, const Compositor& per_pixel,
                                           const Compositor& per_primitive, int x, int y, bool software) {
    const std::string id = method.at("id");
    if (id == "exact" || id == "depth_peeling") return per_pixel.pixel(x, y, Order::by_depth);
    if (id == "f2bx") return per_pixel.pixel(x, y, Order::black);
    if (id == "unsorted") return per_pixel.pixel(x, y, Order::by_submission);
    if (id == "meshkin")
        return per_pixel.pixel(
            x, y, method.value("variant", "simple") == "full" ? Order::meshkin_full : Order::meshkin_simple);
    if (id == "ssam") return per_pixel.pixel(x, y, Order::ssam);
    if (id == "alpha_test") return per_pixel.pixel(x, y, Order::alpha_test);
    if (id == "stencil_cap") return stencil_cap(per_primitive.stack(x, y), 30);
    if (id != "alpha_to_coverage") return per_primitive.pixel(x, y, Order::by_depth);
    if (!software) return std::nullopt;
    return per_pixel.pixel(x, y, Order::alpha_to_coverage);
}

double difference(const Compositor::Color& color, const float* pixel) {
    double greatest = 0;
    for (std::size_t i = 0; i < 3; ++i) greatest = std::max(greatest, std::abs(color[i] - double{pixel[i]}));
    return greatest;
}

class LitmusTest : public testing::Test {
  protected:
    Image picture(const LitmusScene& scene, const json& method) {
        const Spec spec = scene.spec(method);
        return Stage(*m_context, spec, PixelFormat::rgba32f, scene.geometry(spec)).picture(spec.methods[0]);
    }

    /// The greatest error of the picture; the picture must be what theory says.
    double error_of(const Image& image, const LitmusScene& scene, const json& method) const {
        const Compositor truth = scene.truth(), as_sorted = scene.as_sorted();
        double error = 0, off_formula = 0;
        for (int y = 0; y < litmus_size_px; ++y)
            for (int x = 0; x < litmus_size_px; ++x) {
                const auto pixel = image.pixel(x, y);
                error = std::max(error, difference(truth.pixel(x, y, Order::by_depth), &pixel[0]));
                const auto formula = predicted(method, truth, as_sorted, x, y, m_context->device().software);
                if (formula) off_formula = std::max(off_formula, difference(*formula, &pixel[0]));
            }
        EXPECT_LE(off_formula, formula_tolerance(method.at("id")));
        return error;
    }

    /// How much the picture differs from one order of submission to another.
    double change_by_order(const json& method) {
        std::vector<Image> pictures;
        for (const std::uint64_t order : {0, 1, 2, 3, 4, 5}) {
            const LitmusScene scene = shuffled_scene(order);
            pictures.push_back(picture(scene, method));
            error_of(pictures.back(), scene, method);
        }
        double greatest = 0;
        for (const Image& image : pictures) greatest = std::max(greatest, greatest_difference(pictures[0], image));
        return greatest;
    }

    const std::unique_ptr<gl::Context> m_context = make_context("egl");
};

/// A method's place in the table.
class Litmus : public LitmusTest, public testing::WithParamInterface<std::size_t> {};

TEST_P(Litmus, AsItsTheoryPredicts) {
    const json& entry = litmus().at("methods").at(GetParam());
    for (const json& row : entry.at("rows"))
        for (const std::string id : row.at("scenes"))
            for (const json& method : entry.at("variants")) {
                SCOPED_TRACE(method.dump() + " on " + id);
                const bool shuffled = id == "shuffled";
                double error = 0;
                if (shuffled) {
                    error = change_by_order(method);
                } else {
                    const LitmusScene scene = litmus_scene(id);
                    error = error_of(picture(scene, method), scene, method);
                }
                if (row.at("expect") == "passes") {
                    // Additions in another order round otherwise.
                    EXPECT_LE(error, shuffled ? 1e-6 : passes_within) << row.at("why");
                } else {
                    EXPECT_GE(error, fails_from) << row.at("why");
                }
            }
}

std::string entry_name(const testing::TestParamInfo<std::size_t>& place) {
    std::string name = litmus().at("methods").at(place.param).at("name");
    std::ranges::replace_if(
        name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(All, Litmus, testing::Range(std::size_t{0}, litmus().at("methods").size()), entry_name);

TEST(LitmusTable, HasEveryMethodOnEveryScene) {
    for (const MethodInfo& method : all_methods()) {
        const auto is_it = [&](const json& entry) { return entry.at("variants").at(0).at("id") == method.id; };
        EXPECT_TRUE(std::ranges::any_of(litmus().at("methods"), is_it))
            << method.id << ": add its rows to tests/render/litmus.json, and its formula to litmus_test.cpp";
    }
    for (const json& entry : litmus().at("methods")) {
        SCOPED_TRACE(entry.at("name"));
        std::vector<std::string> covered, all;
        for (const json& scene : litmus().at("scenes")) all.push_back(scene.at("id"));
        for (const json& row : entry.at("rows")) {
            EXPECT_TRUE(row.at("expect") == "passes" || row.at("expect") == "fails") << row;
            EXPECT_FALSE(row.at("why").get<std::string>().empty()) << row;
            for (const json& scene : row.at("scenes")) covered.push_back(scene);
        }
        std::ranges::sort(covered);
        std::ranges::sort(all);
        EXPECT_EQ(covered, all);
    }
}

class LitmusDetails : public LitmusTest {};

/// Four layers of alpha 1, C0 farthest: truth minus `simple` is 3 D - C0 - C1 - C2 (slide 21), minus `full` it is
/// 6 D - C0 - C1 - C2 (slide 19).
TEST_F(LitmusDetails, MeshkinIsOffByTheTermsOfTheSlides) {
    const LitmusScene scene = litmus_scene("alpha_to_1");
    const int x = litmus_size_px - 1;
    const Compositor::Stack stack = scene.truth().stack(x, 3);
    ASSERT_EQ(stack.fragments.size(), 4u);
    for (const double weight_of_d : {3.0, 6.0}) {
        const Image image = picture(scene, {{"id", "meshkin"}, {"variant", weight_of_d == 3 ? "simple" : "full"}});
        const float* pixel = image.pixel(x, 3);
        for (std::size_t i = 0; i < 3; ++i) {
            const auto& near_to_far = stack.fragments;
            const double truth = near_to_far[0].color[i];
            const double left_out = near_to_far[1].color[i] + near_to_far[2].color[i] + near_to_far[3].color[i];
            EXPECT_NEAR(truth - double{pixel[i]}, weight_of_d * stack.below[i] - left_out, 1e-6) << weight_of_d << i;
        }
    }
}

/// With all depths at 1 nothing would hide what is behind it.
TEST_F(LitmusDetails, NoPassKeepsTheDepthRangeOfThoseBefore) {
    const LitmusScene scene = litmus_scene("opaque_between");
    for (const MethodInfo& method : all_methods()) {
        const json only_id = {{"id", method.id}};
        m_context->gl().DepthRange(0, 1);
        const Image expected = picture(scene, only_id);
        m_context->gl().DepthRange(1, 1);
        EXPECT_EQ(greatest_difference(picture(scene, only_id), expected), 0) << method.id;
    }
}

/// The layers after the eighth have no say, and each frame leaves the share T of what was wrong before it.
TEST_F(LitmusDetails, StencilCapLosesLayersAndSettles) {
    LitmusScene scene = litmus_scene("64_layers");
    const json method = {{"id", "stencil_cap"}};
    const Image before = picture(scene, method);
    for (std::size_t i = 8; i < scene.layers.size(); ++i) scene.layers[i]["color"] = {0.5, 1, 0};
    EXPECT_EQ(greatest_difference(picture(scene, method), before), 0);

    const double transmittance = std::pow(15.0 / 16, 8);
    const Compositor::Color settled = {0.9, 0.2, 0.1};
    for (const int frames : {1, 2, 5, 30}) {
        const Image image = picture(scene, {{"id", "stencil_cap"}, {"frames", frames}});
        const float* pixel = image.pixel(4, 9);
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(double{pixel[i]},
                        settled[i] + std::pow(transmittance, frames) * (scene.background[i] - settled[i]), 1e-5)
                << frames;
    }
}

}  // namespace

}  // namespace sheer::test::litmus_test
