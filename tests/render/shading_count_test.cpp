// What every method and variant shades, computed fragment by fragment on the CPU: `visible`, which is the same on any
// device, and `shaded`, which on llvmpipe depends on the shader and the state in ways that were found by timing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <optional>

#include "renderer/compare/compare.h"
#include "tests/render/formulas.h"
#include "tests/render/render_test.h"

namespace sheer::test::shading_count_test {

namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr int size_px = 16;

/// Alphas of 0, 1 and between, not submitted in depth order; an opaque layer covers the right half, where it hides
/// three of the eight.
json scene() {
    const std::vector<std::pair<double, double>> depth_and_alpha = {{0.62, 0.5}, {0.15, 0.4}, {0.81, 0.6}, {0.3, 0.03},
                                                                    {0.42, 1},   {0.24, 0.7}, {0.7, 1},    {0.5, 0.9}};
    json layers = json::array();
    for (const auto& [depth, alpha] : depth_and_alpha)
        layers.push_back({{"rect", {0, 0, 1, 1}}, {"depth", depth}, {"color", {1, depth, alpha}}, {"alpha", alpha}});
    layers.push_back({{"rect", {0.5, 0, 1, 1}}, {"depth", 0.55}, {"color", {1, 1, 1}}, {"alpha", 1}, {"opaque", true}});
    return {{"type", "layers"}, {"layers", layers}};
}

/// A fragment as the methods see it; `hidden` is behind the opaque layer.
struct Fragment {
    double depth, alpha;
    bool hidden;
};
using Fragments = std::vector<Fragment>;

Fragments of_pixel(int x) {
    Fragments fragments;
    const json of_scene = scene();
    for (const json& layer : of_scene["layers"])
        if (!layer.value("opaque", false))
            fragments.push_back({layer["depth"], layer["alpha"], x >= size_px / 2 && layer["depth"] > 0.55});
    return fragments;
}

Fragments near_to_far(Fragments fragments) {
    std::ranges::sort(fragments, {}, &Fragment::depth);
    return fragments;
}

int all(const Fragments& fragments) {
    return static_cast<int>(fragments.size());
}

int not_hidden(const Fragments& fragments) {
    return static_cast<int>(std::ranges::count(fragments, false, &Fragment::hidden));
}

/// The depth test against opaque geometry and all fragments that passed the alpha test before, in submission order.
int pass_an_alpha_test(const Fragments& fragments, double reference) {
    double nearest = 1;
    int count = 0;
    for (const Fragment& fragment : fragments) {
        if (fragment.hidden || fragment.depth > nearest) continue;
        ++count;
        if (fragment.alpha >= reference) nearest = fragment.depth;
    }
    return count;
}

/// The stencil counts up to four; fragments that the alpha test drops are not counted.
int pass_a_cap_of_four(const Fragments& fragments, double min_alpha) {
    int count = 0, stencil = 0;
    for (const Fragment& fragment : near_to_far(fragments)) {
        if (fragment.hidden || stencil >= 4) continue;
        ++count;
        if (fragment.alpha >= min_alpha) ++stencil;
    }
    return count;
}

/// Until less than 0.1 is left: 0.6, 0.6 * 0.3 = 0.18, 0.18 * 0.97 = 0.1746, then 0.
int until_under_a_tenth(const Fragments& fragments) {
    double transmittance = 1;
    int count = 0;
    for (const Fragment& fragment : near_to_far(fragments)) {
        if (fragment.hidden || transmittance < 0.1) continue;
        ++count;
        transmittance *= 1 - fragment.alpha;
    }
    return count;
}

/// As before, but a pixel is only closed after every second or third primitive.
int until_marked(const Fragments& fragments, int interval) {
    double transmittance = 1;
    int count = 0, number = 0;
    bool marked = false;
    for (const Fragment& fragment : near_to_far(fragments)) {
        if (number > 0 && number % interval == 0 && transmittance < 0.1) marked = true;
        ++number;
        if (fragment.hidden || marked) continue;
        ++count;
        transmittance *= 1 - fragment.alpha;
    }
    return count;
}

/// Those up to the first one with alpha 1, with or without it.
int until_opaque(const Fragments& fragments, bool with_it) {
    int count = 0;
    for (const Fragment& fragment : near_to_far(fragments)) {
        if (fragment.hidden) break;
        if (fragment.alpha == 1) return count + (with_it ? 1 : 0);
        ++count;
    }
    return count;
}

using Count = std::function<int(const Fragments&)>;

/// `visible` is empty if it is unknown, `on_llvmpipe` if it is the same.
struct Row {
    json method;
    Count visible, on_llvmpipe;
    std::string shaded_by;
};

Count times(int factor, const Count& count) {
    return [=](const Fragments& fragments) { return factor * count(fragments); };
}

const std::vector<Row>& rows() {
    const auto cap = [](double min_alpha) {
        return json{{"id", "stencil_cap"}, {"layers", 4}, {"min_alpha", min_alpha}, {"frames", 2}};
    };
    const Count alpha_test = [](const Fragments& f) { return pass_an_alpha_test(f, 0.5); };
    static const std::vector<Row> all_rows = {
        {{{"id", "b2f"}}, not_hidden, {}, "probed"},
        {{{"id", "f2b"}}, not_hidden, {}, "probed"},
        {{{"id", "unsorted"}}, not_hidden, {}, "probed"},
        {{{"id", "exact"}, {"form", "lists"}}, not_hidden, {}, "specified"},
        {{{"id", "meshkin"}}, not_hidden, {}, "probed"},
        {{{"id", "meshkin"}, {"variant", "full"}}, times(2, not_hidden), {}, "probed"},
        {{{"id", "weighted_average"}}, not_hidden, {}, "probed"},
        {{{"id", "wboit"}}, not_hidden, {}, "probed"},
        // Twice: for what is in front of each fragment, and for its color.
        {{{"id", "mboit"}}, times(2, not_hidden), {}, "probed"},
        {{{"id", "wavelet"}}, times(2, not_hidden), {}, "probed"},
        {{{"id", "nearest_k"}}, times(2, not_hidden), {}, "probed"},
        // Each layer once, in the pass that takes it.
        {{{"id", "dual_depth_peeling"}}, not_hidden, {}, "no_test_fails"},
        {{{"id", "mlab"}}, not_hidden, all, "probed"},
        {{{"id", "f2bd"}, {"threshold", 0.1}, {"batch", 1}}, until_under_a_tenth, {}, "no_test_fails"},
        {{{"id", "f2bd"}, {"threshold", 0}}, not_hidden, {}, "probed"},
        // Reading the framebuffer delays the tests.
        {{{"id", "f2bd"}, {"threshold", 0}, {"feedback", "framebuffer_fetch"}}, not_hidden, all, "probed"},
        {{{"id", "f2bx"}}, [](const Fragments&) { return 0; }, {}, "no_test_fails"},
        {{{"id", "depth_marks"}, {"threshold", 0.1}, {"interval", 3}},
         [](const Fragments& f) { return until_marked(f, 3); },
         {},
         "specified"},
        {{{"id", "depth_marks"}, {"threshold", 0.1}, {"interval", 2}},
         [](const Fragments& f) { return until_marked(f, 2); },
         {},
         "specified"},
        {{{"id", "opaque_depth"}}, {}, not_hidden, "specified"},
        {{{"id", "opaque_depth"}, {"variant", "target_alpha"}}, {}, not_hidden, "specified"},
        // First all that set the stencil, which is tested late; then those in front of the first opaque fragment.
        {{{"id", "opaque_depth"}, {"variant", "two_pass"}},
         [](const Fragments& f) { return until_opaque(f, true) + until_opaque(f, false); },
         [](const Fragments& f) { return all(f) + until_opaque(f, false); },
         "probed"},
        {cap(0), [](const Fragments& f) { return pass_a_cap_of_four(f, 0); }, {}, "specified"},
        // Before shading, the shader itself drops what opaque geometry hides.
        {cap(0.5), [](const Fragments& f) { return pass_a_cap_of_four(f, 0.5); }, not_hidden, "probed"},
        {{{"id", "alpha_test"}}, alpha_test, {}, "probed"},
        {{{"id", "ssam"}, {"alpha_reference", 0.5}},
         [=](const Fragments& f) { return not_hidden(f) + alpha_test(f); },
         {},
         "probed"},
    };
    return all_rows;
}

sheer::Run run_of(const json& of_scene, const json& methods) {
    const Spec spec = parse_spec({{"scene", of_scene},
                                  {"methods", methods},
                                  {"image", {{"width", size_px}, {"height", size_px}}},
                                  {"timing", {{"rounds", 1}}}});
    const auto context = make_context("egl");
    NoAssets assets;
    sheer::Run only;
    compare(
        spec, *context, assets, [](double, const std::string&) {}, [&](const sheer::Run& run) { only = run; });
    return only;
}

std::vector<std::uint32_t> expected(const Count& count) {
    std::vector<std::uint32_t> counts;
    for (int y = 0; y < size_px; ++y)
        for (int x = 0; x < size_px; ++x) counts.push_back(static_cast<std::uint32_t>(count(of_pixel(x))));
    return counts;
}

TEST(ShadingCount, IsThatOfTheCpu) {
    const bool software = make_context("egl")->device().software;
    json methods = json::array();
    for (const Row& row : rows()) methods.push_back(row.method);
    const sheer::Run run = run_of(scene(), methods);
    for (std::size_t i = 0; i < rows().size(); ++i) {
        const Row& row = rows()[i];
        SCOPED_TRACE(row.method.dump());
        const FragmentCounts& counted = run.results[i].fragments;
        if (run.results[i].status == report::ResultStatus::unsupported) continue;
        if (row.visible) {
            ASSERT_TRUE(counted.visible) << counted.no_visible_reason;
            EXPECT_EQ(counted.visible->counts, expected(row.visible));
        } else {
            EXPECT_THAT(counted.no_visible_reason, HasSubstr("writes depth"));
        }
        if (!software) continue;
        ASSERT_TRUE(counted.shaded) << counted.no_shaded_reason;
        EXPECT_EQ(counted.shaded->counts, expected(row.on_llvmpipe ? row.on_llvmpipe : row.visible));
        EXPECT_EQ(counted.shaded_by, row.shaded_by);
    }
}

/// Pixels on the diagonal are shaded for both triangles of a layer, since each covers some of their samples.
TEST(ShadingCount, OfAlphaToCoverageHasEveryFragmentOnLlvmpipe) {
    if (!make_context("egl")->device().software) GTEST_SKIP() << "other devices may test samples early";
    const FragmentCounts counted = run_of(scene(), {"alpha_to_coverage"}).results[0].fragments;
    ASSERT_TRUE(counted.shaded && counted.visible);
    for (int y = 0; y < size_px; ++y) {
        for (int x = 0; x < size_px; ++x) {
            const std::size_t pixel = static_cast<std::size_t>(y) * size_px + x;
            const bool diagonal = x == y || x + y == size_px - 1;
            EXPECT_EQ(counted.shaded->counts[pixel], diagonal && counted.shaded->counts[pixel] != 8 ? 16u : 8u);
            EXPECT_LE(counted.visible->counts[pixel], counted.shaded->counts[pixel]);
            EXPECT_GE(counted.visible->counts[pixel], 1u);
        }
    }
    EXPECT_EQ(counted.shaded_by, "probed");
    EXPECT_LT(counted.visible->total(), counted.shaded->total() * 3 / 4);
}

/// Eight full layers under a cap of four. The coarse pass additionally shades the fragments of its 4 x 4 pixels; its
/// stencil test lets one fragment per coarse pixel through. Without an alpha test it need not shade.
TEST(ShadingCount, OfACapCountsItsCoarsePass) {
    json layers = json::array();
    for (int i = 0; i < 8; ++i)
        layers.push_back({{"rect", {0, 0, 1, 1}}, {"depth", 0.1 + 0.1 * i}, {"color", {1, 1, 1}}, {"alpha", 0.5}});
    const json of_scene = {{"type", "layers"}, {"layers", layers}};
    const auto count = [&](double min_alpha) {
        const json cap = {
            {"id", "stencil_cap"}, {"layers", 4}, {"min_alpha", min_alpha}, {"frames", 1}, {"zcull", true}};
        return run_of(of_scene, json::array({cap})).results[0].fragments;
    };
    constexpr std::uint64_t pixels = size_px * size_px, coarse_pixels = pixels / 16;
    const FragmentCounts with_test = count(0.1), without_test = count(0);
    ASSERT_TRUE(with_test.shaded && with_test.visible && without_test.shaded);
    EXPECT_EQ(with_test.visible->total(), 4 * pixels + coarse_pixels);
    EXPECT_EQ(without_test.shaded->total(), 4 * pixels);
    if (make_context("egl")->device().software) {
        EXPECT_EQ(with_test.shaded->total(), 8 * pixels + 8 * coarse_pixels);
        EXPECT_EQ(with_test.shaded->counts[0] + with_test.shaded->counts[2 * size_px + 2], 8u + 16u)
            << "a coarse pixel is counted at its middle";
    }
}

/// Shaders and states for which the specification does not say when tests are done, as measured on llvmpipe.
TEST(EarlyTests, TellsWhatLlvmpipeDoes) {
    const auto context = make_context("egl");
    if (!context->device().software) GTEST_SKIP() << "what a GPU does is its own";
    EarlyTests tests(*context);
    DrawKind plain;
    plain.tests_depth = plain.writes_depth = true;
    EXPECT_EQ(tests.ask(plain), TestTime::early);
    DrawKind discards = plain;
    discards.discards = true;
    EXPECT_EQ(tests.ask(discards), TestTime::early);
    DrawKind with_stencil = discards;
    with_stencil.tests_stencil = with_stencil.has_stencil_mask = true;
    EXPECT_EQ(tests.ask(with_stencil), TestTime::late);
    DrawKind counts_up = plain;
    counts_up.tests_stencil = counts_up.has_stencil_mask = true;
    counts_up.depth_passes = GL_INCR;
    EXPECT_EQ(tests.ask(counts_up), TestTime::early);
    DrawKind sampled = plain;
    sampled.samples = 4;
    EXPECT_EQ(tests.ask(sampled), TestTime::late);
    DrawKind fetches = plain;
    fetches.fetches_framebuffer = true;
    EXPECT_EQ(tests.ask(fetches), TestTime::late);
    DrawKind masks = with_stencil;
    masks.discards = false;
    masks.writes_sample_mask = true;
    EXPECT_EQ(tests.ask(masks), TestTime::late);
}

}  // namespace

}  // namespace sheer::test::shading_count_test
