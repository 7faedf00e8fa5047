// Every method against the closed form: `layers` scenes of random colours and alphas, opaque layers among them,
// composited on the CPU in double precision.
#include <cmath>

#include "renderer/scene/random.h"
#include "tests/render/compositor.h"
#include "tests/render/render_test.h"

namespace sheer::test::layers_test {

namespace {

constexpr int size_px = 32;

/// One row a method: what its picture must be, and how often its result is rounded to the target's format.
struct MethodRow {
    nlohmann::json method;
    Compositor::Order order;
    bool rounds_each_layer;  // blends in the target's format; false where it blends in floats and is rounded once
    double (*own_tolerance)(PixelFormat format, double layers) = nullptr;  // where neither of these is how it rounds
    bool software_only = false;  // the formula is llvmpipe's; other devices have rules of their own
};

/// Meshkin's sums of n colours and n alphas reach n and are rounded n times; in 32 bits the general rule holds. The
/// opaque picture, rounded by half a level, is weighed by at most n.
double meshkin_tolerance(PixelFormat format, double layers) {
    if (format == PixelFormat::rgba32f) return 1e-5 * layers;
    return layers * (layers + 1) * 0x1p-11 + (format == PixelFormat::rgba8 ? 0.5 * (layers + 1) / 255 : 0x1p-11);
}
/// Beside the sums the product, which is rounded n times, times the reciprocals: at most n.
double meshkin_full_tolerance(PixelFormat format, double layers) {
    if (format == PixelFormat::rgba32f) return 1e-5 * layers;
    return meshkin_tolerance(format, layers) + layers * layers * 0x1p-10 +
           (format == PixelFormat::rgba8 ? 0.5 * layers / 255 : 0);
}

/// The sum of n alphas is off by n half roundings, its square by twice that; two pictures and the result are rounded.
double ssam_tolerance(PixelFormat format, double layers) {
    if (format == PixelFormat::rgba32f) return 1e-5 * layers;
    return (layers + 1.5) * (format == PixelFormat::rgba8 ? 1.0 / 255 : 0x1p-10);
}

/// Each sample is rounded, and their mean.
double coverage_tolerance(PixelFormat format, double) {
    return format == PixelFormat::rgba8 ? 1.0 / 255 : format == PixelFormat::rgba16f ? 0x1p-10 : 1e-5;
}

const std::vector<MethodRow>& rows() {
    using Order = Compositor::Order;
    static const std::vector<MethodRow> all = {
        {{{"id", "b2f"}}, Order::by_depth, true},
        {{{"id", "f2b"}}, Order::by_depth, true},
        {{{"id", "f2b"}, {"alpha_factors", "dst_alpha_zero"}, {"label", "f2b by target"}}, Order::by_depth, true},
        {{{"id", "f2b"}, {"inverted", false}, {"label", "f2b opacity"}}, Order::by_depth, true},
        {{{"id", "f2b"}, {"inverted", false}, {"alpha_factors", "dst_alpha_zero"}, {"label", "f2b opacity by target"}},
         Order::by_depth,
         true},
        // At threshold 0 nothing is under the threshold, so nothing may be discarded.
        {{{"id", "f2bd"}, {"threshold", 0}}, Order::by_depth, true},
        {{{"id", "f2bd"}, {"threshold", 0}, {"alpha_target", "separate"}, {"label", "separate"}},
         Order::by_depth,
         true},
        {{{"id", "f2bd"}, {"threshold", 0}, {"feedback", "framebuffer_fetch"}, {"batch", 3}, {"label", "fetch"}},
         Order::by_depth,
         true},
        {{{"id", "f2bd"},
          {"threshold", 0},
          {"form", "if_discard"},
          {"sync", "flush"},
          {"batch", 3},
          {"label", "flush"}},
         Order::by_depth,
         true},
        {{{"id", "f2bd"}, {"threshold", 0}, {"sync", "finish"}, {"batch", 3}, {"label", "finish"}},
         Order::by_depth,
         true},
        {{{"id", "f2bd"}, {"threshold", 0}, {"inverted", false}, {"label", "f2bd opacity"}}, Order::by_depth, true},
        {{{"id", "f2bd"},
          {"threshold", 0},
          {"inverted", false},
          {"alpha_target", "separate"},
          {"alpha_factors", "dst_alpha_zero"},
          {"label", "separate opacity by target"}},
         Order::by_depth,
         true},
        {{{"id", "f2bd"},
          {"threshold", 0},
          {"inverted", false},
          {"alpha_target", "separate"},
          {"label", "separate opacity"}},
         Order::by_depth,
         true},
        {{{"id", "f2bd"},
          {"threshold", 0},
          {"alpha_target", "separate"},
          {"alpha_factors", "dst_alpha_zero"},
          {"label", "separate by target"}},
         Order::by_depth,
         true},
        // The transmittance starts at 0, so neither layers nor background come through.
        {{{"id", "f2bx"}}, Order::black, true},
        {{{"id", "f2bx"}, {"inverted", false}, {"label", "f2bx opacity"}}, Order::black, true},
        // At threshold 0 nothing is marked.
        {{{"id", "depth_marks"}, {"threshold", 0}, {"interval", 3}}, Order::by_depth, true},
        {{{"id", "opaque_depth"}, {"batch", 3}}, Order::by_depth, true},
        {{{"id", "opaque_depth"}, {"variant", "target_alpha"}, {"batch", 3}, {"label", "target_alpha"}},
         Order::by_depth,
         true},
        {{{"id", "opaque_depth"}, {"variant", "two_pass"}, {"label", "two_pass"}}, Order::by_depth, true},
        {{{"id", "opaque_depth"}, {"marks", "static"}, {"label", "static"}}, Order::by_depth, true},
        {{{"id", "opaque_depth"}, {"marks", "static"}, {"batch", 3}, {"depth_bits", 32}, {"label", "static 32"}},
         Order::by_depth,
         true},
        {{{"id", "opaque_depth"},
          {"variant", "target_alpha"},
          {"marks", "static"},
          {"batch", 3},
          {"mark_pass", "shader"},
          {"label", "static, marked by a shader"}},
         Order::by_depth,
         true},
        {{{"id", "opaque_depth"},
          {"variant", "target_alpha"},
          {"batch", 3},
          {"mark_pass", "shader"},
          {"depth_bits", 32},
          {"label", "marked by a shader"}},
         Order::by_depth,
         true},
        // No pixel reaches the cap, so nothing is cut off or guessed.
        {{{"id", "stencil_cap"}, {"layers", 17}, {"min_alpha", 0}, {"frames", 2}}, Order::by_depth, true},
        {{{"id", "stencil_cap"}, {"layers", 17}, {"min_alpha", 0}, {"frames", 2}, {"zcull", true}, {"label", "zcull"}},
         Order::by_depth,
         true},
        {{{"id", "unsorted"}}, Order::by_submission, true},
        {{{"id", "alpha_test"}}, Order::alpha_test, true},
        {{{"id", "alpha_test"}, {"order", "near_to_far"}, {"label", "sorted alpha test"}}, Order::alpha_test, true},
        {{{"id", "meshkin"}}, Order::meshkin_simple, false, meshkin_tolerance},
        {{{"id", "meshkin"}, {"variant", "full"}, {"label", "full"}},
         Order::meshkin_full,
         false,
         meshkin_full_tolerance},
        {{{"id", "ssam"}}, Order::ssam, false, ssam_tolerance},
        {{{"id", "ssam"}, {"opaque_msaa", 2}, {"label", "ssam msaa"}}, Order::ssam, false, ssam_tolerance},
        {{{"id", "ssam"}, {"drawn_after", 2}, {"label", "ssam and two after"}},
         Order::ssam_and_two_after,
         false,
         ssam_tolerance},
        {{{"id", "alpha_to_coverage"}}, Order::alpha_to_coverage, false, coverage_tolerance, true},
        {{{"id", "exact"}, {"form", "lists"}, {"label", "lists"}}, Order::by_depth, false},
        {{{"id", "exact"}, {"form", "sorted"}, {"label", "sorted"}}, Order::by_depth, false},
        {{{"id", "depth_peeling"}}, Order::by_depth, false},
    };
    return all;
}

/// The largest error that rounding may leave in a picture of `layers` blended layers.
double tolerance(const MethodRow& row, PixelFormat format, std::size_t layers) {
    const auto count = static_cast<double>(layers);
    if (row.own_tolerance != nullptr) return row.own_tolerance(format, count);
    // Rounded once, by half a level at most; else once a layer, and front to back once more where it is laid over the
    // opaque picture.
    const std::string id = row.method.at("id");
    const bool straight = id == "b2f" || id == "unsorted" || id == "alpha_test";
    const double roundings = !row.rounds_each_layer ? 0.501 : straight ? count : count + 1;
    switch (format) {
        case PixelFormat::rgba8:
            return roundings / 255;  // 1/255 per rounding of colour and transmittance
        case PixelFormat::rgba16f:
            return roundings * 0x1p-10;  // 11 significant bits, colour and transmittance
        case PixelFormat::rgba32f:
            return 1e-5 * count;
    }
    return 0;
}

nlohmann::json random_layers(std::size_t count, std::uint64_t seed) {
    Random random(seed);
    nlohmann::json layers = nlohmann::json::array();
    for (std::size_t i = 0; i < count; ++i) {
        // Edges on pixel corners, so that no pixel's middle lies on an edge.
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

struct Case {
    std::string context, format;
    std::size_t layers;
};

void PrintTo(const Case& test_case, std::ostream* out) {
    *out << test_case.context << ' ' << test_case.format << ' ' << test_case.layers;
}

class Layers : public testing::TestWithParam<Case> {};

TEST_P(Layers, AgreeWithDoublePrecision) {
    const Case& test_case = GetParam();
    const auto context = make_context(test_case.context);
    nlohmann::json methods = nlohmann::json::array();
    for (const MethodRow& row : rows()) methods.push_back(row.method);
    const Spec spec =
        make_spec(random_layers(test_case.layers, 7 + test_case.layers), methods, size_px, test_case.format);
    const Compositor compositor(spec.scene, size_px, {0.2, 0.4, 0.6});
    Stage stage(*context, spec, spec.image.format);
    for (std::size_t i = 0; i < rows().size(); ++i) {
        const MethodRow& row = rows()[i];
        if (row.software_only && !context->device().software) continue;
        const Image image = stage.picture(spec.methods[i]);
        double greatest = 0;
        for (int y = 0; y < size_px; ++y)
            for (int x = 0; x < size_px; ++x)
                for (int channel = 0; channel < 3; ++channel)
                    greatest = std::max(greatest, std::abs(compositor.pixel(x, y, row.order)[channel] -
                                                           double{image.pixel(x, y)[channel]}));
        EXPECT_LE(greatest, tolerance(row, spec.image.format, test_case.layers)) << spec.methods[i].label;
    }
}

std::vector<Case> cases() {
    std::vector<Case> all;
    for (const std::string& context : contexts())
        for (const std::string format : {"rgba8", "rgba16f", "rgba32f"})
            for (const std::size_t layers : {1, 2, 4, 16}) all.push_back({context, format, layers});
    return all;
}

std::string case_name(const testing::TestParamInfo<Case>& test_case) {
    const Case& values = test_case.param;
    return values.context + "_" + values.format + "_" + std::to_string(values.layers);
}

INSTANTIATE_TEST_SUITE_P(All, Layers, testing::ValuesIn(cases()), case_name);

TEST(Methods, EachDescribesItselfAndHasARow) {
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
        EXPECT_TRUE(std::ranges::any_of(rows(), [&](const MethodRow& row) { return row.method["id"] == method.id; }))
            << "add a row to tests/render/layers_test.cpp";
    }
}

/// Two layers by hand: red 0.5 over green 0.25 over (0.2, 0.4, 0.6):
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
        // Submitted near first, so without sorting green lies over red: red (0.6, 0.2, 0.3), green (0.45, 0.4, 0.225).
        const std::array<double, 3> expected =
            method.id == "unsorted" ? std::array{0.45, 0.4, 0.225} : std::array{0.575, 0.275, 0.225};
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
