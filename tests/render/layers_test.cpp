// Every method compared with its formula: `layers` scenes with random colors and alphas, some layers opaque, computed
// on the CPU in double precision. Each method's formula is in its row, tests/render/methods/<id>.cpp.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "renderer/core/random.h"
#include "tests/render/method_row.h"
#include "tests/render/render_test.h"

namespace sheer::test::layers_test {

namespace {

constexpr Color background = {0.2, 0.4, 0.6};

struct Case {
    std::string context, format;
    std::size_t layers;
    int size_px = 32;
};

void PrintTo(const Case& test_case, std::ostream* out) {
    *out << test_case.context << ' ' << test_case.format << ' ' << test_case.layers;
}

std::uint64_t seed_of(const Case& test_case) {
    return 7 + test_case.layers;
}

/// Rectangles at random places, every fifth one opaque.
nlohmann::json random_layers(const Case& test_case) {
    Random random(seed_of(test_case));
    const double size_px = test_case.size_px;
    nlohmann::json layers = nlohmann::json::array();
    for (std::size_t i = 0; i < test_case.layers; ++i) {
        // Edges on pixel corners, so that no pixel's middle is on an edge.
        const double x0 = static_cast<double>(random.below(20)) / size_px,
                     y0 = static_cast<double>(random.below(20)) / size_px;
        const double x1 = x0 + static_cast<double>(4 + random.below(20)) / size_px;
        const double y1 = y0 + static_cast<double>(4 + random.below(20)) / size_px;
        layers.push_back({{"rect", {x0, y0, x1, y1}},
                          {"depth", random.between(0.05, 0.95)},
                          {"color", {random.unit(), random.unit(), random.unit()}},
                          {"alpha", random.unit()},
                          {"opaque", i % 5 == 2}});
    }
    return {{"type", "layers"}, {"layers", layers}};
}

/// So many that sums, products and counters reach their limits. Every pixel has all of them, since what a method
/// carries from frame to frame is only known for uniform pictures.
nlohmann::json full_layers(const Case& test_case) {
    Random random(seed_of(test_case));
    nlohmann::json layers = nlohmann::json::array();
    for (std::size_t i = 0; i < test_case.layers; ++i)
        layers.push_back({{"rect", {0, 0, 1, 1}},
                          {"depth", random.between(0.05, 0.95)},
                          {"color", {random.unit(), random.unit(), random.unit()}},
                          {"alpha", random.unit()}});
    return {{"type", "layers"}, {"layers", layers}};
}

/// Where a picture is furthest from its formula, relative to the bound: above 1 it is wrong.
struct Worst {
    double bounds = 0;
    std::string text;
};

/// A color whose formula leaves 0 to 1 is clamped. A NaN is wrong.
Worst worst_pixel(const Image& image, const Compositor& compositor, const Formula& formula, const Bound& bound_of,
                  PixelFormat format) {
    Worst worst;
    for (int y = 0; y < image.height_px; ++y)
        for (int x = 0; x < image.width_px; ++x) {
            const Stack stack = compositor.stack(x, y);
            const Color expected = formula(stack);
            const double bound = bound_of(stack, format);
            for (int channel = 0; channel < 3; ++channel) {
                const double actual = image.pixel(x, y)[channel], wanted = expected[static_cast<std::size_t>(channel)];
                const double least = std::clamp(wanted - bound, 0.0, 1.0), most = std::clamp(wanted + bound, 0.0, 1.0);
                const double off = std::max({0.0, least - actual, actual - most});
                const double bounds = std::isfinite(actual) ? off / bound : std::numeric_limits<double>::infinity();
                if (bounds <= worst.bounds) continue;
                worst = {bounds, fmt::format("pixel ({}, {}), channel {}: expected {:.6g} within {:.3g}, actual {:.6g}",
                                             x, y, "rgb"[channel], wanted, bound, actual)};
            }
        }
    return worst;
}

/// The row's variants.
nlohmann::json variants_of(const MethodRow& row) {
    nlohmann::json methods = nlohmann::json::array();
    for (const MethodVariant& variant : row.variants) {
        nlohmann::json method = method_json(row, variant.parameters);
        method["label"] = fmt::format("{} {}", methods.size(), row.id);
        methods.push_back(std::move(method));
    }
    return methods;
}

/// `./dev check METHOD` sets SHEER_METHOD to test only that method.
bool is_wanted(const MethodRow& row) {
    const char* only = std::getenv("SHEER_METHOD");
    return only == nullptr || row.id == only;
}

/// GPUs may round what they blend to the next but one level.
Bound on_a_gpu(const Bound& bound) {
    return [bound](const Stack& stack, PixelFormat format) { return 2 * bound(stack, format); };
}

void expect_formulas(const Case& test_case, const nlohmann::json& scene) {
    const auto context = make_context(test_case.context);
    const Spec spec = make_spec(scene, {"exact"}, test_case.size_px, test_case.format);
    const Compositor compositor(spec.scene, test_case.size_px, background);
    Stage stage(*context, spec, spec.image.format);
    for (const MethodRow& row : all_method_rows()) {
        if (!is_wanted(row)) continue;
        const Spec of_row = make_spec(scene, variants_of(row), test_case.size_px, test_case.format);
        for (std::size_t i = 0; i < row.variants.size(); ++i) {
            const MethodVariant& variant = row.variants[i];
            if (variant.software_only && !context->device().software) continue;
            if (test_case.layers > variant.most_layers) continue;
            std::optional<Image> picture;
            try {
                picture = stage.picture(of_row.methods[i]);
            } catch (const Unsupported&) {
                continue;
            }
            const Worst worst =
                worst_pixel(*picture, compositor, row.formula(variant.parameters),
                            context->device().software ? variant.bound : on_a_gpu(variant.bound), spec.image.format);
            EXPECT_EQ(worst.bounds, 0) << row.id << ' ' << variant.parameters << ", seed " << seed_of(test_case) << ": "
                                       << worst.text;
        }
    }
}

class Layers : public testing::TestWithParam<Case> {};

TEST_P(Layers, AgreeWithDoublePrecision) {
    expect_formulas(GetParam(), random_layers(GetParam()));
}

class ManyLayers : public testing::TestWithParam<Case> {};

TEST_P(ManyLayers, AgreeWithDoublePrecision) {
    expect_formulas(GetParam(), full_layers(GetParam()));
}

std::vector<Case> cases(const std::vector<std::string>& formats, const std::vector<std::size_t>& layers, int size_px) {
    std::vector<Case> all;
    for (const std::string& context : contexts())
        for (const std::string& format : formats)
            for (const std::size_t count : layers) all.push_back({context, format, count, size_px});
    return all;
}

std::string case_name(const testing::TestParamInfo<Case>& test_case) {
    const Case& values = test_case.param;
    return values.context + "_" + values.format + "_" + std::to_string(values.layers);
}

INSTANTIATE_TEST_SUITE_P(All, Layers, testing::ValuesIn(cases({"rgba8", "rgba16f", "rgba32f"}, {1, 2, 4, 16}, 32)),
                         case_name);
/// 1,024 layers take seconds with every method, and contexts differ in nothing that grows with layers.
std::vector<Case> many_layers() {
    std::vector<Case> all = cases({"rgba8", "rgba16f"}, {64}, 4);
    for (const char* format : {"rgba8", "rgba16f"}) all.push_back({"egl", format, 1024, 4});
    return all;
}
INSTANTIATE_TEST_SUITE_P(All, ManyLayers, testing::ValuesIn(many_layers()), case_name);

TEST(Methods, EachDescribesItself) {
    for (const MethodInfo& method : all_methods()) {
        SCOPED_TRACE(method.id);
        EXPECT_FALSE(method.name.empty());
        EXPECT_FALSE(method.kind.empty());
        EXPECT_FALSE(method.summary.empty());
        EXPECT_FALSE(method.paper.empty());
        EXPECT_FALSE(method.good_at.empty());
        EXPECT_FALSE(method.bad_at.empty());
        EXPECT_FALSE(method.memory.empty());
        EXPECT_TRUE(method.make);
        for (const Param& param : method.parameters) EXPECT_FALSE(param.summary.empty()) << param.name;
    }
}

TEST(Methods, EachHasARow) {
    for (const MethodInfo& method : all_methods()) {
        SCOPED_TRACE(method.id);
        ASSERT_NO_THROW(method_row(method.id)) << "add tests/render/methods/" << method.id << ".cpp";
        EXPECT_FALSE(method_row(method.id).variants.empty());
        EXPECT_TRUE(method_row(method.id).formula);
    }
    for (const MethodRow& row : all_method_rows()) EXPECT_NE(find_method(row.id), nullptr) << row.id;
    try {
        method_row("none");
        FAIL() << "a method without a row was given one";
    } catch (const std::out_of_range& error) {
        EXPECT_STREQ(error.what(), "none has no row: add tests/render/methods/none.cpp");
    }
}

TEST(WorstPixel, IsFoundWhereAValueIsNoNumber) {
    const Compositor compositor({{"layers", nlohmann::json::array()}}, 2, background);
    const Formula below = [](const Stack& stack) { return stack.below; };
    Image image(2, 2);
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 2; ++x)
            for (std::size_t c = 0; c < 3; ++c) image.pixel(x, y)[c] = static_cast<float>(background[c]);
    EXPECT_EQ(worst_pixel(image, compositor, below, rounded_once, PixelFormat::rgba8).bounds, 0);
    image.pixel(1, 0)[2] = std::numeric_limits<float>::quiet_NaN();
    const Worst worst = worst_pixel(image, compositor, below, rounded_once, PixelFormat::rgba8);
    EXPECT_GT(worst.bounds, 1);
    EXPECT_NE(worst.text.find("pixel (1, 0), channel b: expected 0.6"), std::string::npos) << worst.text;
}

/// Bounds that grow with the number of layers could become meaningless.
TEST(Bounds, OfAThousandLayersAreStillNarrow) {
    const Case test_case = {"", "", 1024, 4};
    const Compositor compositor(parse_spec({{"scene", full_layers(test_case)}, {"methods", {"b2f"}}}).scene, 4,
                                background);
    const Stack stack = compositor.stack(0, 0);
    ASSERT_EQ(stack.fragments.size(), 1024u);
    for (const auto bound : {rounded_back_to_front, rounded_front_to_back, rounded_with_opacity}) {
        EXPECT_LT(bound(stack, PixelFormat::rgba8), 20.0 / 255);
        // The step of opacity that may be missing lets a little of every layer through.
        EXPECT_LT(bound(stack, PixelFormat::rgba16f), bound == rounded_with_opacity ? 0.4 : 0.02);
    }
}

/// Two layers worked out by hand: red 0.5 over green 0.25 over (0.2, 0.4, 0.6):
/// green over the background (0.15, 0.55, 0.45), red over that (0.575, 0.275, 0.225).
TEST(LayersByHand, Two) {
    const nlohmann::json scene = {{"type", "layers"},
                                  {"layers",
                                   {{{"rect", {0, 0, 1, 1}}, {"depth", 0.2}, {"color", {1, 0, 0}}, {"alpha", 0.5}},
                                    {{"rect", {0, 0, 1, 1}}, {"depth", 0.7}, {"color", {0, 1, 0}}, {"alpha", 0.25}}}}};
    const auto context = make_context("egl");
    const Spec spec = make_spec(scene, {"b2f", "f2b", "f2bd", "exact", "depth_peeling", "unsorted"}, 4, "rgba32f");
    Stage stage(*context, spec, PixelFormat::rgba32f);
    for (const MethodSpec& method : spec.methods) {
        const Image image = stage.picture(method);
        // Submitted near first, so without sorting green is over red: red (0.6, 0.2, 0.3), green (0.45, 0.4, 0.225).
        const Color expected = method.id == "unsorted" ? Color{0.45, 0.4, 0.225} : Color{0.575, 0.275, 0.225};
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(image.pixel(2, 1)[channel], expected[channel], 1e-6) << method.id;
    }
}

/// The rectangle's place: origin top left, y down.
TEST(LayersByHand, OriginIsTopLeft) {
    const nlohmann::json scene = {
        {"type", "layers"},
        {"layers", {{{"rect", {0, 0, 0.25, 0.5}}, {"depth", 0.5}, {"color", {1, 1, 1}}, {"alpha", 1}}}}};
    for (const std::string& kind : contexts()) {
        const auto context = make_context(kind);
        const Spec spec = make_spec(scene, {"b2f"}, 4);
        Stage stage(*context, spec, PixelFormat::rgba8);
        const Image image = stage.picture(spec.methods[0]);
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 4; ++x) EXPECT_EQ(image.pixel(x, y)[0] == 1.0f, x < 1 && y < 2) << kind << x << y;
    }
}

}  // namespace

}  // namespace sheer::test::layers_test
