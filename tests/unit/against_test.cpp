// The comparison of a report with an accepted one.
#include "renderer/diff/against.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/core/sha256.h"
#include "renderer/files/report_document.h"
#include "renderer/pictures/picture_file.h"

namespace sheer::against_test {

namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class AgainstTest : public testing::Test {
  protected:
    json picture(int level) {
        Image8 image(4, 2);
        image.pixel(1, 1)[0] = static_cast<std::uint8_t>(level);
        const std::string png = encode_png(image), sha256 = sha256_hex(png);
        m_files[sha256] = png;
        return {{"sha256", sha256}, {"url", sha256}, {"media_type", "image/png"}};
    }

    /// Twelve rounds that differ by a hundredth each.
    static json timing(double base_ms) {
        json samples = json::array();
        for (int round = 0; round < 12; ++round) samples.push_back(base_ms * (1 + 0.01 * round));
        return {{"clock", "wall"}, {"samples", samples}, {"gpu_samples", samples}, {"wall_samples", samples}};
    }

    /// b2f takes 10 ms, f2bd `f2bd_ms`, in each round.
    report::Report make(const std::string& id, double f2bd_ms = 5, int level = 0, const json& more = json::object()) {
        json spec = {
            {"title", "t"},
            {"image", {{"width", 4}, {"height", 2}}},
            {"scene", {{"type", "quads"}, {"count", 3}}},
            {"methods", {{{"id", "b2f"}, {"label", "b2f"}}, {{"id", "f2bd"}, {"label", "f2bd"}, {"threshold", 0.01}}}},
            {"baseline", "b2f"},
            {"against", "baseline:main"}};
        spec.update(more);
        json results = json::array();
        for (const char* method : {"b2f", "f2bd"})
            results.push_back({{"method", method},
                               {"label", method},
                               {"status", "ok"},
                               {"images", {{"color", picture(method == std::string("f2bd") ? level : 0)}}},
                               {"timing", timing(method == std::string("f2bd") ? f2bd_ms : 10)}});
        return read_report({{"id", id},
                            {"status", "done"},
                            {"created_at", "2026-01-01T00:00:00.000Z"},
                            {"spec", spec},
                            {"device", {{"renderer", "r"}, {"cpu", "c"}}},
                            {"runs",
                             {{{"point", json::object()},
                               {"noise_floor", {{"factor", 1.02}}},
                               {"reference", {{"method", "exact"}, {"images", {{"color", picture(0)}}}}},
                               {"results", results}}}}});
    }

    static Accepted accepted(const report::Report& report) {
        return {report, "main", "2026-01-01T00:00:00Z", "me", "2 days"};
    }

    report::Report compared(report::Report now, const std::vector<Accepted>& all) {
        const auto read = [this](const report::Picture& one) { return m_files.at(one.url); };
        compare_against(now, all, read, read);
        return now;
    }

    /// "metric of method: outcome" of each check.
    static std::vector<std::string> outcomes(const report::Report& report) {
        std::vector<std::string> all;
        for (const report::Check& check : report.checks)
            all.push_back(check.metric + " of " + check.method + ": " + word_of(check.came_out()));
        return all;
    }

    std::map<std::string, std::string> m_files;
};

TEST_F(AgainstTest, TheSameAgainPasses) {
    const report::Report now = compared(make("b"), {accepted(make("a"))});
    EXPECT_THAT(outcomes(now), ElementsAre("against.flip.mean of b2f: passed", "against.flip.mean of f2bd: passed",
                                           "against.slowdown of f2bd: passed"));
    EXPECT_EQ(now.verdict, report::ReportVerdict::passed);
    EXPECT_EQ(now.against->report, "a");
    EXPECT_EQ(
        now.against->text,
        "compared with a of main, accepted 2 days ago by me, because it was made by the same device, r on c, from "
        "the same spec");
}

/// 6.5 / 5 is 1.3 in each round.
TEST_F(AgainstTest, ASlowerMethodFailsByItsInterval) {
    const report::Report now = compared(make("b", 6.5), {accepted(make("a"))});
    const report::Check& slowdown = now.checks.back();
    EXPECT_EQ(slowdown.metric, "against.slowdown");
    EXPECT_NEAR(slowdown.value.value(), 1.3, 1e-9);
    EXPECT_EQ(slowdown.max, 1.1);
    EXPECT_EQ(slowdown.came_out(), report::CheckOutcome::failed);
    EXPECT_EQ(now.verdict, report::ReportVerdict::failed);
    EXPECT_EQ(now.verdict_reason, "1 of 3 checks failed");
    const json tolerant = {{"tolerance", {{"max_flip", 0}, {"max_slowdown", 1.5}}}};
    EXPECT_EQ(compared(make("b", 6.5, 0, tolerant), {accepted(make("a"))}).verdict, report::ReportVerdict::passed);
}

TEST_F(AgainstTest, AChangedPictureFailsUnlessItIsTolerated) {
    const report::Report now = compared(make("b", 5, 200), {accepted(make("a"))});
    EXPECT_EQ(outcomes(now)[1], "against.flip.mean of f2bd: failed");
    EXPECT_EQ(now.checks[1].reason, "1 pixels differ");
    const double flip = now.checks[1].value.value();
    EXPECT_GT(flip, 0);
    const json tolerance = {{"tolerance", {{"max_flip", flip * 1.01}, {"max_slowdown", 1.1}}}};
    EXPECT_EQ(compared(make("b", 5, 200, tolerance), {accepted(make("a"))}).verdict, report::ReportVerdict::passed);
}

TEST_F(AgainstTest, AMethodThatNoLongerRendersFails) {
    report::Report now = make("b");
    now.runs[0].results[1].status = report::ResultStatus::unsupported;
    now.runs[0].results[1].timing.reset();
    EXPECT_THAT(outcomes(compared(now, {accepted(make("a"))})),
                ElementsAre("against.flip.mean of b2f: passed", "against.flip.mean of f2bd: failed"));
}

TEST_F(AgainstTest, OnlyTheSameDeviceAndSpecAreTaken) {
    report::Report other_device = make("device");
    other_device.device->renderer = "another";
    const report::Report other_spec = make("spec", 5, 0, {{"scene", {{"type", "quads"}, {"count", 4}}}});
    const report::Report now = compared(make("b"), {accepted(other_device), accepted(other_spec), accepted(make("a"))});
    EXPECT_EQ(now.against->report, "a");
    ASSERT_EQ(now.against->refused.size(), 2u);
    EXPECT_EQ(now.against->refused[0].reason, "it was made by another on c, and this one by r on c");
    EXPECT_THAT(now.against->refused[1].differing, ElementsAre("/scene/count"));
}

TEST_F(AgainstTest, WhatIsUnderTestMayDiffer) {
    const report::Report before = make("a", 5, 0, {{"scene", {{"type", "quads"}, {"count", 4}}}, {"title", "other"}});
    const report::Report now = compared(make("b", 5, 0, {{"under_test", {"/scene/count"}}}), {accepted(before)});
    EXPECT_EQ(now.against->report, "a") << now.against->text;
    EXPECT_THAT(now.against->text, HasSubstr("from the same spec except for /scene/count"));
}

/// If the scene is under test, all methods may be slower: b2f and f2bd take 1.3 times as long.
TEST_F(AgainstTest, IfTheBaselineMethodChangesTooEachTimeIsComparedWithItself) {
    report::Report now =
        make("b", 6.5, 0, {{"scene", {{"type", "quads"}, {"count", 4}}}, {"under_test", {"/scene/count"}}});
    now.runs[0].results[0].timing = from_document<report::Timing>(timing(13));
    now = compared(now, {accepted(make("a"))});
    EXPECT_THAT(outcomes(now), ElementsAre("against.flip.mean of b2f: passed", "against.slowdown of b2f: failed",
                                           "against.flip.mean of f2bd: passed", "against.slowdown of f2bd: failed"));
    EXPECT_NEAR(now.checks[1].value.value(), 1.3, 1e-2);
    // The same times with the same scene are those of a slower machine.
    report::Report slower_machine = make("b", 6.5);
    slower_machine.runs[0].results[0].timing = from_document<report::Timing>(timing(13));
    EXPECT_EQ(compared(slower_machine, {accepted(make("a"))}).verdict, report::ReportVerdict::passed);
}

TEST_F(AgainstTest, WithoutAnyReportTheGateFailsAndSaysWhy) {
    report::Report now = compared(make("b"), {});
    EXPECT_THAT(outcomes(now), ElementsAre("against of baseline:main: failed"));
    EXPECT_EQ(now.checks[0].reason, "there is no report to compare with: baseline:main has no accepted report");
    EXPECT_EQ(now.verdict, report::ReportVerdict::failed);
    const report::Report differing = make("a", 5, 0, {{"scene", {{"type", "quads"}, {"count", 4}}}});
    now = compared(make("b"), {accepted(differing)});
    EXPECT_THAT(now.checks[0].reason, HasSubstr("a: its spec differs in /scene/count, which `under_test`"));
    EXPECT_FALSE(now.against->report);
    EXPECT_EQ(now.verdict, report::ReportVerdict::failed);
}

}  // namespace

}  // namespace sheer::against_test
