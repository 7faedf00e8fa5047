#include "renderer/report/markdown.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sheer::markdown_test {

namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

report::Check check(const std::string& metric, report::CheckOutcome outcome, const std::string& reason = "") {
    return {.metric = metric,
            .method = "f2bd",
            .max = 0.05,
            .value = 0.0054417629114,
            .outcome = outcome,
            .passed = outcome == report::CheckOutcome::passed,
            .reason = reason};
}

report::Report made() {
    report::Report report;
    report.status = report::Status::done;
    report.spec = {{"title", "a | b <i>"}, {"timing", {{"max_seconds", 60}}}};
    report.verdict = report::ReportVerdict::failed;
    report.verdict_reason = "1 of 3 checks failed";
    using enum report::CheckOutcome;
    report.checks = {check("rmse", passed),
                     check("speedup", undecided, "the limit lies within its interval [0.9, 1.1]"),
                     check("flip.mean", failed)};
    report::Run run;
    run.results.push_back({.method = "f2bd", .label = "f2bd"});
    run.results.push_back({.method = "b2f",
                           .label = "old",
                           .status = report::ResultStatus::failed,
                           .reason = "GL_OUT_OF_MEMORY\nin b2f"});
    run.results[0].images["color"] = {.sha256 = "1", .url = "/blobs/1", .media_type = "image/png"};
    report.runs.push_back(run);
    return report;
}

TEST(Markdown, BeginsWithTheVerdictAndWhatFailed) {
    const std::string text = report_markdown(made());
    EXPECT_THAT(text, StartsWith("### Sheer: failed: a &#124; b &#60;i&#62;\n\n1 of 3 checks failed.\n"))
        << "a title is not markup";
    EXPECT_THAT(text,
                HasSubstr("| outcome | check | value | wanted | |\n|---|---|---|---|---|\n"
                          "| failed | flip.mean of f2bd | 0.00544 | at most 0.05 |  |\n"
                          "| undecided | speedup of f2bd | 0.00544 | at most 0.05 | the limit lies within its "
                          "interval &#91;0.9, 1.1&#93;; more time would decide it: timing.max&#95;seconds over 60 |\n"
                          "| passed | rmse of f2bd | 0.00544 | at most 0.05 |  |\n"));
    EXPECT_THAT(text, HasSubstr("| old | - | - | - | failed: GL&#95;OUT&#95;OF&#95;MEMORY in b2f |\n"));
    EXPECT_THAT(text, Not(HasSubstr("<img")));
}

TEST(Markdown, SaysWhatWouldDecideAComparisonWithABaseline) {
    report::Report report = made();
    report.checks = {check("against.slowdown", report::CheckOutcome::undecided, "it is wide")};
    EXPECT_THAT(report_markdown(report), HasSubstr("it is wide; a larger timing.rounds would decide it |"));
}

TEST(Markdown, LinksPicturesAndTheReport) {
    const std::string text =
        report_markdown(made(), {.report = "http://s/#/r", .picture_prefix = "http://s", .pictures = true});
    EXPECT_THAT(text, HasSubstr("[The report](http://s/#/r)\n"));
    EXPECT_THAT(text,
                HasSubstr("<a href=\"http://s/blobs/1\"><img src=\"http://s/blobs/1\" width=\"96\" alt=\"\"></a> "));
}

TEST(Markdown, OfAReportThatFailedSaysWhy) {
    report::Report report;
    report.status = report::Status::failed;
    report.error = report::Error{"Rendering failed", "it died"};
    EXPECT_EQ(report_markdown(report), "### Sheer: failed\n\nRendering failed: it died\n");
}

TEST(Annotations, AreOneLineForEachCheckThatDidNotPass) {
    EXPECT_EQ(
        report_annotations(made(), "a,b:c.json"),
        "::warning file=a%2Cb%3Ac.json,title=Sheer::speedup of f2bd is undecided, wanted at most 0.05: the limit lies "
        "within its interval [0.9, 1.1]\n"
        "::error file=a%2Cb%3Ac.json,title=Sheer::flip.mean of f2bd is 0.00544, wanted at most 0.05\n"
        "::error file=a%2Cb%3Ac.json,title=Sheer::old failed to render: GL_OUT_OF_MEMORY%0Ain b2f\n");
    report::Report report;
    report.error = report::Error{"100 %", "::error::no"};
    EXPECT_EQ(report_annotations(report, ""), "::error title=Sheer::100 %25: ::error::no\n");
}

}  // namespace

}  // namespace sheer::markdown_test
