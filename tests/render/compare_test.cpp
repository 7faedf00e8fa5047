// A whole comparison: its results, how it is timed, and how it ends early.
#include "renderer/compare/compare.h"

#include <gmock/gmock.h>

#include <set>

#include "tests/render/render_test.h"

namespace sheer::test::compare_test {

namespace {

nlohmann::json small_quads() {
    return {
        {"type", "quads"}, {"count", 30}, {"shading", "4x4-textures"}, {"texture", {{"image", "leaf"}, {"size", 64}}}};
}

Spec small_spec(const nlohmann::json& timing = {{"rounds", 3}}) {
    return parse_spec({{"scene", small_quads()},
                       {"methods", {"b2f", "f2b", "f2bd", "f2bx"}},
                       {"image", {{"width", 48}, {"height", 40}}},
                       {"timing", timing}});
}

const ProgressFunction no_progress = [](double, const std::string&) {};

std::vector<sheer::Run> compare_here(const Spec& spec, gl::Context& context, const ProgressFunction& progress) {
    NoAssets assets;
    std::vector<sheer::Run> runs;
    compare(spec, context, assets, progress, [&](const sheer::Run& run) { runs.push_back(run); });
    return runs;
}

TEST(Compare, GivesEveryMethodItsPictureTimesAndMetrics) {
    const auto context = make_context("egl");
    const auto runs = compare_here(small_spec(), *context, no_progress);
    ASSERT_EQ(runs.size(), 1u);
    const sheer::Run& run = runs[0];
    EXPECT_EQ(run.reference_image.width_px, 48);
    EXPECT_EQ(run.reference_image.height_px, 40);
    ASSERT_TRUE(run.residual.has_value());
    EXPECT_LT(*run.residual, 1e-5);
    ASSERT_EQ(run.results.size(), 4u);
    for (const MethodResult& result : run.results) {
        SCOPED_TRACE(result.method.label);
        EXPECT_EQ(result.status, report::ResultStatus::ok);
        EXPECT_EQ(result.image.pixel_count(), 48u * 40u);
        EXPECT_EQ(result.samples.size(), 3u);
        for (const gl::FrameSample& sample : result.samples) EXPECT_GT(sample.wall_ms, 0);
        EXPECT_EQ(result.metrics.has_value(), result.method.id != "f2bx");
    }
    EXPECT_EQ(run.results[0].memory_bytes, 0);
    EXPECT_EQ(run.results[1].memory_bytes, 48 * 40 * 4);
    EXPECT_FALSE(run.results[3].no_metrics_reason.empty());
    // 30 layers round at most once each in 8 bits.
    EXPECT_LE(run.results[0].metrics->values["signed"]["max"], 30);
}

TEST(Compare, IsRepeatable) {
    const auto context = make_context("egl");
    const auto first = compare_here(small_spec(), *context, no_progress);
    const auto other_context = make_context("egl");
    const auto second = compare_here(small_spec(), *other_context, no_progress);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(first[0].results[i].image.rgba, second[0].results[i].image.rgba);
}

TEST(Compare, StopsTimingAfterItsTimeButNotBeforeOneRound) {
    const auto context = make_context("egl");
    const auto runs = compare_here(small_spec({{"rounds", 1000}, {"max_seconds", 0.001}}), *context, no_progress);
    for (const MethodResult& result : runs[0].results) {
        EXPECT_GE(result.samples.size(), 1u);
        EXPECT_LT(result.samples.size(), 1000u);
    }
}

TEST(Compare, TimesTheBaselineTwiceInEveryRoundAndSaysHowManyThereWere) {
    const auto context = make_context("egl");
    const sheer::Run all = compare_here(small_spec(), *context, no_progress).at(0);
    EXPECT_EQ(all.rounds_done, 3);
    EXPECT_EQ(all.baseline_again.size(), 3u);
    const auto short_time = small_spec({{"rounds", 1000}, {"max_seconds", 0.001}});
    const sheer::Run cut = compare_here(short_time, *context, no_progress).at(0);
    EXPECT_EQ(cut.rounds_done, 1) << "any second round takes over a millisecond";
    EXPECT_EQ(cut.baseline_again.size(), 1u);
    EXPECT_EQ(cut.results[0].samples.size(), 1u);
}

TEST(Compare, ProgressGrowsAndNamesEachStage) {
    const auto context = make_context("egl");
    std::vector<double> fractions;
    std::set<std::string> stages;
    compare_here(small_spec(), *context, [&](double fraction, const std::string& stage) {
        fractions.push_back(fraction);
        stages.insert(stage);
    });
    EXPECT_TRUE(std::ranges::is_sorted(fractions));
    EXPECT_EQ(fractions.front(), 0);
    EXPECT_LT(fractions.back(), 1);
    for (const char* stage : {"building the scene", "warming up f2bd", "timing round 2 of 3",
                              "counting the fragments of f2bx", "measuring b2f"})
        EXPECT_TRUE(stages.contains(stage)) << stage;
}

TEST(Compare, EndsWithWhatTheCallerThrowsBetweenRounds) {
    struct Enough {};
    const auto context = make_context("egl");
    const ProgressFunction stop = [](double, const std::string& stage) {
        if (stage == "timing round 2 of 3") throw Enough();
    };
    EXPECT_THROW(compare_here(small_spec(), *context, stop), Enough);
    EXPECT_NO_THROW(compare_here(small_spec(), *context, no_progress)) << "the context is still of use";
}

TEST(Compare, ChecksTheReferenceAtEveryPoint) {
    const Spec spec = parse_spec({{"scene", small_quads()},
                                  {"methods", {"b2f"}},
                                  {"reference", {{"id", "exact"}, {"form", "lists"}}},
                                  {"image", {{"width", 16}, {"height", 16}}},
                                  {"timing", {{"rounds", 1}}},
                                  {"sweep", {{{"pointer", "/scene/count"}, {"values", {1, 8, 20}}}}}});
    const auto context = make_context("egl");
    const auto runs = compare_here(spec, *context, no_progress);
    ASSERT_EQ(runs.size(), 3u);
    for (const sheer::Run& run : runs) {
        ASSERT_TRUE(run.residual.has_value());
        EXPECT_LT(*run.residual, 1e-5);
        EXPECT_EQ(run.reference_findings["lists"]["kept"], run.overdraw.total());
    }
}

/// A method that cannot run here is reported, and the others are still compared.
TEST(Compare, ReportsWhatIsUnsupported) {
    const Spec spec =
        parse_spec({{"scene", {{"type", "quads"}, {"count", 40000}, {"distribution", "full"}, {"shading", "constant"}}},
                    {"methods", {"b2f", {{"id", "exact"}, {"form", "lists"}, {"memory_mib", 1}}}},
                    {"image", {{"width", 2}, {"height", 1}}},
                    {"timing", {{"rounds", 1}}}});
    const auto context = make_context("egl");
    const auto runs = compare_here(spec, *context, no_progress);
    EXPECT_EQ(runs[0].results[0].status, report::ResultStatus::ok);
    EXPECT_EQ(runs[0].results[1].status, report::ResultStatus::unsupported);
    EXPECT_THAT(runs[0].results[1].reason, testing::HasSubstr("40000 fragments"));
    EXPECT_TRUE(runs[0].results[1].samples.empty());
}

}  // namespace

}  // namespace sheer::test::compare_test
