// How many fragments each method shades, and how many it needed to: compared with a composite in double precision on
// the CPU if the scene is `layers`, and with each other otherwise.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "renderer/compare/compare.h"
#include "renderer/counting/needed.h"
#include "tests/render/formulas.h"
#include "tests/render/render_test.h"

namespace sheer::test::fragments_test {

namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr int size_px = 16;

/// An opaque rectangle in the middle of a stack of eight, of which each is smaller than the one behind it; in reverse.
json stack_of_layers(double alpha) {
    json layers = json::array();
    for (int i = 0; i < 8; ++i) {
        const double edge = i / 20.0;
        layers.push_back({{"rect", {edge, edge, 1, 1}},
                          {"depth", 0.9 - 0.1 * i},
                          {"color", {0.1 * i, 0.5, 1 - 0.1 * i}},
                          {"alpha", alpha},
                          {"opaque", false}});
    }
    layers.push_back(
        {{"rect", {0.5, 0, 1, 0.5}}, {"depth", 0.55}, {"color", {1, 1, 1}}, {"alpha", 1}, {"opaque", true}});
    return {{"type", "layers"}, {"layers", layers}};
}

json quads(int count) {
    return {{"type", "quads"},
            {"count", count},
            {"shading", "4x4-textures"},
            {"texture", {{"image", "leaf"}, {"size", 64}}}};
}

sheer::Run run_of(const json& scene, const json& methods, const std::string& format = "rgba8", int width_px = size_px) {
    const Spec spec = parse_spec({{"scene", scene},
                                  {"methods", methods},
                                  {"image", {{"width", width_px}, {"height", size_px}, {"format", format}}},
                                  {"timing", {{"rounds", 1}}}});
    const auto context = make_context("egl");
    NoAssets assets;
    sheer::Run only;
    compare(
        spec, *context, assets, [](double, const std::string&) {}, [&](const sheer::Run& run) { only = run; });
    return only;
}

/// A number for each pixel, from its fragments sorted from near to far.
PixelCounts on_the_cpu(const json& scene, const std::function<std::uint32_t(const std::vector<Fragment>&)>& f) {
    const Compositor compositor(scene, size_px, {0, 0, 0});
    PixelCounts counts{size_px, size_px, {}};
    for (int y = 0; y < size_px; ++y) {
        for (int x = 0; x < size_px; ++x) {
            auto fragments = compositor.stack(x, y).fragments;
            std::ranges::stable_sort(fragments, std::less(), &Fragment::depth);
            counts.counts.push_back(f(fragments));
        }
    }
    return counts;
}

PixelCounts needed_on_the_cpu(const json& scene, double threshold) {
    return on_the_cpu(scene, [=](const auto& fragments) {
        double transmittance = 1;
        std::uint32_t needed = 0;
        for (const auto& fragment : fragments) {
            if (transmittance < threshold) break;
            ++needed;
            transmittance *= 1 - fragment.alpha;
        }
        return needed;
    });
}

/// With alpha 0.5 the transmittances are 1/2, 1/4, ..., which no threshold here is near.
TEST(Fragments, NeededIsThatOfACompositeOnTheCpu) {
    const json scene = stack_of_layers(0.5);
    for (const std::string format : {"rgba8", "rgba16f", "rgba32f"}) {
        for (const double threshold : {0.0, 0.01, 0.1, 0.3, 1.0}) {
            SCOPED_TRACE(format + ", threshold " + std::to_string(threshold));
            const json f2bd = {{"id", "f2bd"}, {"threshold", threshold}, {"batch", 1}};
            const sheer::Run run = run_of(scene, {"f2b", f2bd}, format);
            const FragmentCounts& fragments = run.results[1].fragments;
            const PixelCounts expected = needed_on_the_cpu(scene, threshold);
            ASSERT_TRUE(fragments.needed && fragments.shaded && fragments.saturation);
            EXPECT_EQ(fragments.needed->counts, expected.counts);
            EXPECT_EQ(fragments.shaded->counts, expected.counts);
        }
    }
}

TEST(Fragments, SaturationLayerIsTheOneThatFallsBelowTheThreshold) {
    const json scene = stack_of_layers(0.5);
    const sheer::Run run = run_of(scene, {"f2b", {{"id", "f2bd"}, {"threshold", 0.1}}});
    // 0.5^4 = 0.0625 is the first under 0.1.
    const PixelCounts expected =
        on_the_cpu(scene, [](const auto& fragments) { return fragments.size() >= 4 ? 4u : 0u; });
    EXPECT_EQ(run.results[1].fragments.saturation->counts, expected.counts);
    EXPECT_GT(expected.total(), 0u);
    EXPECT_EQ(run.results[0].fragments.saturation, std::nullopt) << "f2b has no threshold";
}

/// One full frame of f2b shades what is submitted; so does every other method that shades each fragment once.
TEST(Fragments, MethodsThatNeverDiscardShadeAllThatIsSubmitted) {
    const json scene = stack_of_layers(0.5);
    const sheer::Run run = run_of(
        scene, {"b2f", "f2b", "unsorted", {{"id", "exact"}, {"form", "lists"}}, {{"id", "f2bd"}, {"threshold", 0}}});
    const PixelCounts submitted = on_the_cpu(scene, [](const auto& f) { return std::uint32_t(f.size()); });
    EXPECT_EQ(run.overdraw.counts, submitted.counts);
    for (const MethodResult& result : run.results) {
        SCOPED_TRACE(result.method.id);
        ASSERT_TRUE(result.fragments.shaded) << result.fragments.no_shaded_reason;
        EXPECT_EQ(result.fragments.shaded->counts, submitted.counts);
        EXPECT_EQ(result.fragments.needed->counts, submitted.counts);
    }
}

TEST(Fragments, F2bdShadesWhatIsNeededOfQuads) {
    const int batch = exact_batch(*make_context("egl"));
    for (const std::string format : {"rgba8", "rgba16f", "rgba32f"}) {
        SCOPED_TRACE(format);
        const sheer::Run run = run_of(quads(200),
                                      {"f2b",
                                       {{"id", "f2bd"}, {"batch", batch}},
                                       {{"id", "f2bd"}, {"threshold", 0.2}, {"batch", batch}, {"label", "much"}},
                                       "f2bx"},
                                      format, 40);
        const auto& f2b = run.results[0].fragments;
        EXPECT_EQ(f2b.shaded->counts, run.overdraw.counts);
        for (const std::size_t i : {1u, 2u}) {
            const FragmentCounts& fragments = run.results[i].fragments;
            EXPECT_EQ(fragments.shaded->counts, fragments.needed->counts) << run.results[i].method.label;
            EXPECT_LT(fragments.needed->total(), run.overdraw.total());
        }
        EXPECT_LT(run.results[2].fragments.needed->total(), run.results[1].fragments.needed->total());
        EXPECT_EQ(run.results[3].fragments.shaded->total(), 0u) << "f2bx shades nothing";
    }
}

/// `layers` from far to near or from near to far: the alpha test shades what its own depth test lets through.
TEST(Fragments, AnAlphaTestIsCountedAsItsDepthTestGoes) {
    if (!make_context("egl")->device().software) GTEST_SKIP() << "a GPU may test after shading";
    const json far_to_near = stack_of_layers(0.6);
    json near_to_far = far_to_near;
    std::ranges::reverse(near_to_far["layers"]);
    const PixelCounts submitted = on_the_cpu(far_to_near, [](const auto& f) { return std::uint32_t(f.size()); });
    const PixelCounts covered = on_the_cpu(far_to_near, [](const auto& f) { return f.empty() ? 0u : 1u; });
    const json passes = {{{"id", "alpha_test"}, {"reference", 0.5}}},
               fails = {{{"id", "alpha_test"}, {"reference", 0.9}}};
    EXPECT_EQ(run_of(far_to_near, passes).results[0].fragments.shaded->counts, submitted.counts);
    EXPECT_EQ(run_of(near_to_far, passes).results[0].fragments.shaded->counts, covered.counts);
    EXPECT_EQ(run_of(near_to_far, fails).results[0].fragments.shaded->counts, submitted.counts)
        << "no depth is written";
}

TEST(Fragments, WhatCannotBeToldHasAReason) {
    if (!make_context("egl")->device().software) GTEST_SKIP() << "a GPU may test after shading, which is known";
    const sheer::Run peeled = run_of(stack_of_layers(0.5), {"depth_peeling"});
    EXPECT_EQ(peeled.results[0].fragments.shaded, std::nullopt);
    EXPECT_THAT(peeled.results[0].fragments.no_shaded_reason, HasSubstr("samples pass"));
    EXPECT_EQ(peeled.results[0].status, report::ResultStatus::ok);
}

/// Primitives that may intersect are peeled, layer by layer; only `parallel` distinguishes these from others.
TEST(Fragments, NeededOfWhatMayIntersectIsThatOfACompositeOnTheCpu) {
    const json scene = stack_of_layers(0.5);
    const Spec spec =
        parse_spec({{"scene", scene}, {"methods", {"f2b"}}, {"image", {{"width", size_px}, {"height", size_px}}}});
    NoAssets assets;
    Geometry geometry = build_geometry(spec.scene, spec.image, assets);
    geometry.parallel = false;
    const auto context = make_context("egl");
    for (const PixelFormat format : {PixelFormat::rgba8, PixelFormat::rgba32f}) {
        const Stage stage(*context, spec, format, geometry);
        gl::FrameTimer timer(*context);
        gl::FrameTimer::Frame frame = timer.frame(false);
        const NeededFragments counted = count_needed(context->gl(), stage.scene(), stage.target(), 0.1f, timer);
        frame.end();
        EXPECT_EQ(counted.needed.counts, needed_on_the_cpu(scene, 0.1).counts);
        EXPECT_EQ(counted.saturation.counts,
                  on_the_cpu(scene, [](const auto& f) { return f.size() >= 4 ? 4u : 0u; }).counts);
        EXPECT_EQ(why_needed_is_unknown(stage.scene(), {1, 1, {19999}}), "");
        EXPECT_THAT(why_needed_is_unknown(stage.scene(), {1, 1, {20001}}), HasSubstr("intersect"));
    }
}

TEST(Fragments, FoliageIsCounted) {
    const sheer::Run run = run_of({{"type", "foliage"}, {"trees", 1}}, {"f2b", {{"id", "f2bd"}, {"threshold", 0.3}}});
    const std::uint64_t needed = run.results[1].fragments.needed->total();
    EXPECT_GT(needed, 0u);
    EXPECT_LE(needed, run.overdraw.total());
}

/// Counting must not change the picture, so for every method the picture is compared with one without counting.
TEST(Fragments, EveryMethodCanBeCounted) {
    json methods = json::array();
    for (const MethodInfo& method : all_methods()) methods.push_back(method.id);
    const sheer::Run run = run_of(quads(20), methods, "rgba8", 24);
    for (const MethodResult& result : run.results) {
        SCOPED_TRACE(result.method.id);
        if (result.status != report::ResultStatus::ok) continue;
        EXPECT_NE(result.fragments.shaded.has_value(), !result.fragments.no_shaded_reason.empty());
        EXPECT_TRUE(result.fragments.needed.has_value());
        if (!result.fragments.shaded) continue;
        EXPECT_EQ(result.fragments.shaded->total() == 0, result.method.id == "f2bx");
    }
}

TEST(CountPicture, GoesFromBlackToPaleYellow) {
    const Image8 picture = count_picture({3, 1, {0, 10, 20}}, 10);
    EXPECT_THAT(picture.rgb, testing::ElementsAre(0, 0, 4, 252, 253, 191, 252, 253, 191));
    EXPECT_EQ(count_picture({1, 1, {0}}, 0).rgb, (std::vector<std::uint8_t>{0, 0, 4})) << "nothing was counted";
}

}  // namespace

}  // namespace sheer::test::fragments_test
