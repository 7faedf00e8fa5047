#include "renderer/report/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <limits>

#include "renderer/command/command.h"
#include "renderer/core/sha256.h"
#include "renderer/pictures/blob_sink.h"
#include "renderer/pictures/picture_file.h"
#include "tests/unit/map_sink.h"

namespace sheer::report_test {

namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string table_of(const json& made) {
    return report_table(from_document<report::Report>(made));
}

std::string junit_of(const json& made) {
    return report_junit(from_document<report::Report>(made));
}

int exit_code_of(const json& made) {
    return cli::exit_code_of(from_document<report::Report>(made));
}

TEST(Sha256, OfKnownTexts) {
    EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

gl::FrameSample sample(double wall_ms, double gpu_ms) {
    return {wall_ms,
            gpu_ms,
            true,
            {{"clear", gl::Phase::initialization, 1},
             {"transparent", gl::Phase::transparent, gpu_ms - 3},
             {"composite", gl::Phase::finalization, 2}}};
}

/// b2f takes 10, 20, ... 60 ms; f2bd half of that in each round; f2bx is unsupported.
struct ReportFixture : testing::Test {
    Spec spec = parse_spec({{"title", "A & \"B\""},
                            {"scene", {{"type", "quads"}}},
                            {"methods", {"b2f", {{"id", "f2bd"}, {"label", "F2BD <1>"}}, "f2bx"}},
                            {"image", {{"width", 4}, {"height", 2}}},
                            {"checks",
                             {{{"metric", "speedup"}, {"method", "f2bd"}, {"min", 1.9}, {"max", 2.1}},
                              {{"metric", "signed.max"}, {"method", "F2BD <1>"}, {"max", 50}},
                              {{"metric", "psnr"}, {"method", "b2f"}, {"min", 99}},
                              {{"metric", "rmse"}, {"method", "f2bx"}, {"max", 1}}}}});
    Device device;
    std::vector<sheer::Run> runs;
    MapSink sink;

    ReportFixture() {
        device.info.renderer = "test";
        device.info.context = "egl";
        device.info.software = true;
        sheer::Run run;
        run.reference = spec.reference;
        run.reference_image = Image(4, 2);
        run.no_residual_reason = "too many";
        run.results.resize(3);
        // 80 fragments, 10 per pixel; f2bd needs and shades 2 per pixel.
        run.overdraw = {4, 2, std::vector<std::uint32_t>(8, 10)};
        run.rounds_done = 6;
        for (int round = 1; round <= 6; ++round) run.baseline_again.push_back(sample(10.5 * round, 9.45 * round));
        for (std::size_t i = 0; i < 3; ++i) {
            MethodResult& result = run.results[i];
            result.method = spec.methods[i];
            result.image = Image(4, 2);
            for (int round = 1; round <= 6; ++round)
                result.samples.push_back(sample(10.0 * round / (i + 1), 9.0 * round / (i + 1)));
        }
        // 0.2 is 51 levels over the black of the reference.
        run.results[1].image.pixel(2, 1)[1] = 0.2f;
        for (std::size_t i = 0; i < 2; ++i)
            run.results[i].metrics = compute_metrics(run.reference_image, run.results[i].image);
        run.results[0].fragments = {{run.overdraw, "", "specified", run.overdraw, ""}, run.overdraw, "", {}};
        const PixelCounts one{4, 2, std::vector<std::uint32_t>(8, 1)}, two{4, 2, std::vector<std::uint32_t>(8, 2)};
        run.results[1].fragments = {{two, "", "probed", one, ""}, two, "", two};
        run.results[2].status = report::ResultStatus::unsupported;
        run.results[2].reason = "no <barrier>";
        runs.push_back(std::move(run));
    }

    json report() {
        ReportMaker maker(spec, device, &sink, "2026-01-01T00:00:00.000Z");
        for (const sheer::Run& run : runs) maker.add(run);
        return to_document(maker.finish());
    }
};

TEST_F(ReportFixture, TimesAndSpeedupsAreThoseOfTheSamples) {
    const json made = report();
    const json& b2f = made["runs"][0]["results"][0];
    const json& f2bd = made["runs"][0]["results"][1];
    // The wall clock is used for a software rasteriser.
    EXPECT_EQ(b2f["timing"]["clock"], "wall");
    EXPECT_EQ(b2f["timing"]["samples"], json({10.0, 20.0, 30.0, 40.0, 50.0, 60.0}));
    EXPECT_EQ(b2f["timing"]["median"], 35);
    EXPECT_EQ(b2f["timing"]["initialization"], 1);
    EXPECT_EQ(b2f["timing"]["finalization"], 2);
    EXPECT_EQ(b2f["timing"]["passes"][1]["median"], 9 * 3.5 - 3);
    EXPECT_EQ(f2bd["timing"]["median"], 17.5);
    EXPECT_EQ(b2f["speedup"], json({{"value", 1.0},
                                    {"ci95", {1.0, 1.0}},
                                    {"verdict", "not resolved"},
                                    {"reason", "it is the baseline"},
                                    {"compared", 1}}));
    EXPECT_EQ(
        f2bd["speedup"],
        json({{"value", 2.0}, {"ci95", {2.0, 2.0}}, {"verdict", "faster"}, {"reason", nullptr}, {"compared", 1}}));
}

/// A method in another look is compared with its counterpart: 51 levels in one pixel, and 2 / 3 of the time.
TEST_F(ReportFixture, AChangeIsComparedWithTheSameMethodInTheOtherLook) {
    MethodResult& before = runs[0].results[1];
    MethodResult after = before;
    after.method.label = "new";
    after.method.look = {{"shading", "constant"}};
    after.image.pixel(0, 0)[2] = 0.2f;
    after.samples.clear();
    for (int round = 1; round <= 6; ++round) after.samples.push_back(sample(3.0 * round, 2.5 * round));
    after.change = PictureChange{before.method.label, false, compute_metrics(before.image, after.image)};
    runs[0].results[0].no_change_reason = "it has no counterpart";
    runs[0].results.push_back(after);
    const json results = report()["runs"][0]["results"];
    const json& change = results[3]["change"];
    EXPECT_EQ(change["from"], "F2BD <1>");
    EXPECT_EQ(change["identical"], false);
    EXPECT_EQ(change["metrics"]["differing_pixels"], 1);
    EXPECT_EQ(change["metrics"]["signed"]["min"], -51);
    // 5, 10, ... 30 ms over 3, 6, ... 18 ms; the baseline differs from itself by 10.5 / 10.
    EXPECT_NEAR(change["speedup"]["value"].get<double>(), 5.0 / 3, 1e-12);
    EXPECT_EQ(change["speedup"]["verdict"], "faster");
    EXPECT_EQ(change["speedup"]["compared"], 1);
    EXPECT_TRUE(results[1]["change"].is_null());
    EXPECT_FALSE(results[1].contains("change_reason")) << "it has no look of its own";
    EXPECT_EQ(results[0]["change_reason"], "it has no counterpart");
    EXPECT_THAT(table_of(report()), HasSubstr("Change from F2BD <1> to new: the picture is different, mean FLIP"));
}

/// Times of b2f over times of f2bd: 2 in each round but two, in which it is 1 and 4.
struct UndecidedFixture : ReportFixture {
    UndecidedFixture() {
        json document = spec.normalised;
        document["checks"] = {{{"metric", "speedup"}, {"method", "F2BD <1>"}, {"min", 1.9}}};
        spec = parse_spec(document);
        runs[0].results[1].samples[0] = sample(10, 9);
        runs[0].results[1].samples[1] = sample(5, 4.5);
    }
};

TEST_F(UndecidedFixture, MoreRoundsAreAskedForUntilTheIntervalDecides) {
    ReportMaker maker(spec, device, nullptr, "2026-01-01T00:00:00.000Z");
    const UndecidedFunction is_undecided = maker.undecided();
    ASSERT_TRUE(is_undecided);
    sheer::Run& run = runs[0];
    run.looks = 1;
    EXPECT_TRUE(is_undecided(run)) << "six rounds are too few for an interval of the first look";
    const auto add_rounds = [&](int rounds) {
        for (int i = 0; i < rounds; ++i) {
            run.results[0].samples.push_back(sample(10, 9));
            run.results[1].samples.push_back(sample(5, 4.5));
            run.baseline_again.push_back(sample(10, 9));
        }
    };
    add_rounds(6);
    run.looks = 2;
    EXPECT_FALSE(is_undecided(run)) << "the least but one of 12 ratios is 2";
    spec.checks.clear();
    EXPECT_FALSE(ReportMaker(spec, device, nullptr, "").undecided()) << "there is nothing that more rounds decide";
}

TEST_F(UndecidedFixture, TheIntervalIsThatOfTheLook) {
    // 12 ratios: ranks 3 and 10 at 0.05, 2 and 11 at 0.0125.
    for (int i = 0; i < 6; ++i) {
        runs[0].results[0].samples.push_back(sample(10, 9));
        runs[0].results[1].samples.push_back(sample(10 / (2.1 + 0.1 * i), 4));
    }
    const auto interval = [&] { return report()["runs"][0]["results"][1]["speedup"]["ci95"]; };
    // Sorted: 1, 2, 2, 2, 2, 2.1, 2.2, 2.3, 2.4, 2.5, 2.6, 4.
    EXPECT_NEAR(interval()[1].get<double>(), 2.5, 1e-9);
    runs[0].looks = 2;
    EXPECT_NEAR(interval()[1].get<double>(), 2.6, 1e-9);
    EXPECT_EQ(report()["runs"][0]["rounds"]["looks"], 2);
}

TEST_F(UndecidedFixture, TheSpecSaysWhatUndecidedCountsAs) {
    const auto with = [&](const std::string& counts) {
        json document = spec.normalised;
        document["on_undecided"] = counts;
        spec = parse_spec(document);
        return report();
    };
    json made = with("neutral");
    EXPECT_EQ(made["verdict"], "undecided");
    EXPECT_EQ(made["verdict_reason"], "1 of 1 checks undecided");
    EXPECT_EQ(exit_code_of(made), 0);
    EXPECT_THAT(junit_of(made), HasSubstr("<skipped message=\"undecided: "));
    made = with("fail");
    EXPECT_EQ(made["verdict"], "failed");
    EXPECT_EQ(made["verdict_reason"], "1 of 1 checks undecided, which counts as failed");
    EXPECT_EQ(made["checks"][0]["outcome"], "undecided");
    EXPECT_EQ(exit_code_of(made), 5);
    EXPECT_THAT(junit_of(made), HasSubstr("<failure message=\"undecided: "));
    made = with("pass");
    EXPECT_EQ(made["verdict"], "passed");
    EXPECT_EQ(exit_code_of(made), 0);
    EXPECT_THAT(junit_of(made), Not(HasSubstr("message=\"undecided")));
}

TEST_F(ReportFixture, AGateWithoutChecksFails) {
    spec.checks.clear();
    auto made = from_document<report::Report>(report());
    EXPECT_EQ(made.verdict, report::ReportVerdict::none);
    require_checks(made);
    EXPECT_EQ(made.verdict, report::ReportVerdict::failed);
    EXPECT_EQ(cli::exit_code_of(made), 1);
    EXPECT_THAT(report_junit(made), HasSubstr("name=\"checks of the gate\""));
}

TEST_F(ReportFixture, TheBaselineIsComparedWithItself) {
    const json run = report()["runs"][0];
    EXPECT_EQ(run["rounds"], json({{"asked", 10}, {"done", 6}, {"needed", 6}, {"looks", 0}}));
    EXPECT_EQ(run["noise_floor"]["method"], "b2f");
    // Ratios, like everything else in it: 10 / 10.5 in each round.
    ASSERT_EQ(run["noise_floor"]["samples"].size(), 6u);
    for (const json& ratio : run["noise_floor"]["samples"]) EXPECT_NEAR(ratio.get<double>(), 1 / 1.05, 1e-12);
    EXPECT_NEAR(run["noise_floor"]["value"].get<double>(), 1 / 1.05, 1e-9);
    EXPECT_NEAR(run["noise_floor"]["factor"].get<double>(), 1.05, 1e-9);

    // If the second instance is 2.5 times as slow, a method twice as fast is within the noise.
    for (gl::FrameSample& frame : runs[0].baseline_again) frame.wall_ms *= 2.5;
    const json speedup = report()["runs"][0]["results"][1]["speedup"];
    EXPECT_EQ(speedup["verdict"], "not resolved");
    EXPECT_EQ(speedup["reason"], "inside the noise floor");

    runs[0].results[0].status = report::ResultStatus::unsupported;
    runs[0].baseline_again.clear();
    EXPECT_TRUE(report()["runs"][0]["noise_floor"].is_null());
    EXPECT_TRUE(report()["runs"][0]["results"][1]["speedup"].is_null());
}

TEST_F(ReportFixture, SortingIsReportedAndSpeedupsAreGivenWithIt) {
    // b2f takes 10, 20, ... ms and 30 ms of sorting; f2bd half of that and no sorting.
    runs[0].results[0].sorts = true;
    runs[0].results[0].sort_ms = {30, 30, 30, 30, 30, 30};
    runs[0].baseline_again_sort_ms = {30, 30, 30, 30, 30, 30};
    const json results = report()["runs"][0]["results"];
    const json& sort = results[0]["timing"]["sort"];
    EXPECT_EQ(sort["median"], 30);
    EXPECT_EQ(sort["mad"], 0);
    EXPECT_EQ(sort["samples"], json(std::vector(6, 30.0)));
    EXPECT_EQ(sort["ci95"], json({30.0, 30.0}));
    EXPECT_EQ(sort["clock"], "wall");
    EXPECT_TRUE(results[1]["timing"]["sort"].is_null());
    EXPECT_EQ(results[1]["timing"]["sort_reason"], "the method needs no sorting");
    EXPECT_EQ(results[1]["speedup"]["value"], 2.0) << "of the frames only";
    // (10 + 30) / 5 = 8, 50 / 10 = 5, 60 / 15 = 4, 70 / 20 = 3.5, 80 / 25 = 3.2, 90 / 30 = 3.
    EXPECT_DOUBLE_EQ(results[1]["speedup_with_sort"]["value"].get<double>(), 3.75);
    EXPECT_EQ(results[1]["speedup_with_sort"]["ci95"], json({3.0, 8.0}));
    EXPECT_EQ(results[1]["speedup_with_sort"]["verdict"], "faster");
    EXPECT_EQ(results[0]["speedup_with_sort"]["value"], 1.0);
    EXPECT_THAT(table_of(report()), HasSubstr("3.75x [3.00, 8.00]"));

    spec.checks = {{"speedup_with_sort", "F2BD <1>", 3.0, nullptr, json::object()},
                   {"timing.sort.median", "b2f", nullptr, 29, json::object()},
                   {"timing.sort.median", "F2BD <1>", nullptr, 29, json::object()}};
    const json checks = report()["checks"];
    EXPECT_EQ(checks[0]["passed"], true);
    EXPECT_EQ(checks[1]["passed"], false);
    EXPECT_TRUE(checks[1]["reason"].is_null());
    EXPECT_EQ(checks[2]["reason"], "the method needs no sorting");

    runs[0].results[0].sort_ms.clear();
    runs[0].no_sort_reason = "preparing the sort: memory ran out";
    const json without = report()["runs"][0]["results"];
    EXPECT_EQ(without[0]["timing"]["sort_reason"], "preparing the sort: memory ran out");
    EXPECT_TRUE(without[1]["speedup_with_sort"].is_null());
    EXPECT_THAT(without[1]["speedup_with_sort_reason"].get<std::string>(), HasSubstr("memory ran out"));
}

TEST_F(ReportFixture, AComparisonOfNothingPassesNoCheck) {
    spec.checks = {{"rmse", "b2f", nullptr, 1, json::object()}};
    EXPECT_EQ(report()["verdict"], "passed");
    const std::string why = "Nothing transparent was drawn: all of it has an alpha of 0.";
    runs[0].nothing_drawn = why;
    const json made = report();
    EXPECT_EQ(made["runs"][0]["nothing_drawn"], why);
    EXPECT_EQ(made["checks"][0]["passed"], false);
    EXPECT_EQ(made["checks"][0]["reason"], why);
    EXPECT_EQ(made["verdict"], "failed");
    EXPECT_EQ(made["verdict_reason"], "1 of 1 checks failed; " + why);
    EXPECT_EQ(exit_code_of(made), exit_check_failed);
    EXPECT_THAT(junit_of(made), AllOf(HasSubstr("<failure"), HasSubstr(why), HasSubstr("<skipped")));
    EXPECT_THAT(table_of(made), HasSubstr(why));
    spec.checks.clear();
    EXPECT_EQ(report()["verdict"], "none");
    EXPECT_EQ(report()["verdict_reason"], why);
}

TEST_F(ReportFixture, AFailedMethodDoesNotPassSilently) {
    spec.checks = {{"rmse", "b2f", nullptr, 1, json::object()}};
    EXPECT_EQ(report()["verdict"], "passed") << "unsupported is not a failure";
    EXPECT_TRUE(report()["verdict_reason"].is_null());
    EXPECT_EQ(exit_code_of(report()), exit_ok);
    runs[0].results[2].status = report::ResultStatus::failed;
    runs[0].results[2].reason = "timing f2bx: GL_OUT_OF_MEMORY";
    EXPECT_EQ(report()["verdict"], "failed");
    EXPECT_EQ(report()["verdict_reason"], "f2bx failed: timing f2bx: GL_OUT_OF_MEMORY");
    EXPECT_EQ(exit_code_of(report()), exit_render_failed) << "no check failed";
    spec.checks.clear();
    EXPECT_EQ(report()["verdict"], "failed") << "even if there are no checks";
    spec.checks = {{"rmse", "f2bx", nullptr, 1, json::object()}};
    EXPECT_EQ(report()["checks"][0]["reason"], "failed: timing f2bx: GL_OUT_OF_MEMORY");
    EXPECT_EQ(exit_code_of(report()), exit_check_failed) << "a check did";
}

TEST_F(ReportFixture, AFailedBaselineIsTheReasonForMissingSpeedups) {
    runs[0].results[0].status = report::ResultStatus::failed;
    runs[0].results[0].reason = "rendering b2f: GL_INVALID_ENUM";
    const json made = report();
    const std::string reason = "the baseline b2f is failed: rendering b2f: GL_INVALID_ENUM";
    EXPECT_EQ(made["runs"][0]["results"][1]["speedup_reason"], reason);
    EXPECT_EQ(made["runs"][0]["results"][0]["speedup_reason"], "rendering b2f: GL_INVALID_ENUM");
    EXPECT_EQ(made["checks"][0]["passed"], false);
    EXPECT_EQ(made["checks"][0]["reason"], reason);
    EXPECT_FALSE(report()["runs"][0]["results"][1]["timing"].is_null());
}

TEST_F(ReportFixture, AFailedReferenceIsReportedAndHasNoPicture) {
    runs[0].reference_status = report::ResultStatus::failed;
    runs[0].reference_reason = "rendering the reference exact: GL_OUT_OF_MEMORY";
    runs[0].reference_image = {};
    for (MethodResult& result : runs[0].results) {
        result.metrics.reset();
        result.no_metrics_reason = "the reference exact is failed";
    }
    const json made = report();
    EXPECT_EQ(made["runs"][0]["reference"]["status"], "failed");
    EXPECT_EQ(made["runs"][0]["reference"]["reason"], runs[0].reference_reason);
    EXPECT_TRUE(made["runs"][0]["reference"]["images"].empty());
    EXPECT_EQ(made["checks"][1]["reason"], "the reference exact is failed");
    EXPECT_THAT(made["verdict_reason"].get<std::string>(),
                HasSubstr("the reference exact failed: rendering the reference exact: GL_OUT_OF_MEMORY"));
}

TEST_F(ReportFixture, IntervalsAreCorrectedForTheNumberOfMethods) {
    // With two methods beside the baseline, 2.5 % are allowed for each; for six rounds the whole range is missed in 3.1
    // %.
    runs[0].results[2].status = report::ResultStatus::ok;
    const json speedup = report()["runs"][0]["results"][1]["speedup"];
    EXPECT_EQ(speedup["compared"], 2);
    EXPECT_TRUE(speedup["ci95"].is_null());
    EXPECT_EQ(speedup["verdict"], "not resolved");
}

TEST_F(ReportFixture, NotesAreListedOnceAndReachTableAndJunit) {
    const Note skipped{"extension-ignored", "KHR_x & y is left out.", "/scene/model: materials[2]"};
    runs[0].notes = {skipped};
    runs[0].results[1].notes = {{"too-bright", "Sums overflowed.", ""}};
    runs.push_back(runs[0]);
    const json made = report();
    EXPECT_EQ(made["notes"], json::parse(R"([{"code": "extension-ignored", "text": "KHR_x & y is left out.",
                               "where": "/scene/model: materials[2]"},
                              {"code": "too-bright", "text": "Sums overflowed.", "where": null}])"));
    EXPECT_EQ(made["runs"][1]["notes"], json::array({made["notes"][0]}));
    EXPECT_EQ(made["runs"][1]["results"][1]["notes"], json::array({made["notes"][1]}));
    EXPECT_THAT(table_of(made), HasSubstr("Note: /scene/model: materials[2]: KHR_x & y is left out.\n"
                                          "Note: Sums overflowed.\n"));
    EXPECT_THAT(junit_of(made), HasSubstr("<property name=\"note.extension-ignored\" "
                                          "value=\"/scene/model: materials[2]: KHR_x &amp; y is left out.\" />"));
}

TEST_F(ReportFixture, FilesAreListedOnce) {
    const SourceFile model{"/scene/model", {"a.gltf", "", "aa", 12}},
        part{"/scene/model", {"a.bin", "a.gltf", "bb", 3}};
    runs[0].files = {model, part};
    runs.push_back(runs[0]);
    // The part was rewritten between the two points.
    runs[1].files[1].file.sha256 = "cc";
    const json made = report();
    EXPECT_EQ(made["files"], json::parse(R"([
        {"pointer": "/scene/model", "name": "a.gltf", "of": null, "sha256": "aa", "bytes": 12},
        {"pointer": "/scene/model", "name": "a.bin", "of": "a.gltf", "sha256": "bb", "bytes": 3},
        {"pointer": "/scene/model", "name": "a.bin", "of": "a.gltf", "sha256": "cc", "bytes": 3}])"));
    EXPECT_EQ(made["runs"][1]["files"], json::array({made["files"][0], made["files"][2]}));
}

/// Six ratios from 1 to 3, whose interval at one comparison is all of them.
TEST_F(ReportFixture, AChecksTimeIsDecidedByItsIntervalOnly) {
    runs[0].results[1].samples[0] = sample(10, 9);
    runs[0].results[1].samples[5] = sample(20, 18);
    const auto check = [&](double min, double max) {
        spec.checks = {{"speedup", "F2BD <1>", min, max, json::object()}};
        return report();
    };
    const json made = check(1.5, 10), undecided = made["checks"][0];
    EXPECT_EQ(made["runs"][0]["results"][1]["speedup"]["ci95"], json({1.0, 3.0}));
    EXPECT_EQ(undecided["outcome"], "undecided");
    EXPECT_EQ(undecided["passed"], false);
    EXPECT_EQ(undecided["reason"], "the limit lies within its interval [1, 3]");
    EXPECT_EQ(made["verdict"], "undecided");
    EXPECT_THAT(table_of(made), HasSubstr("undecided  speedup of F2BD <1> is 2, at least 1.5"));
    EXPECT_THAT(junit_of(made), HasSubstr("failures=\"0\""));
    EXPECT_THAT(junit_of(made), HasSubstr("<skipped message=\"undecided: is 2"));

    EXPECT_EQ(check(0.9, 3)["checks"][0]["outcome"], "passed");
    EXPECT_EQ(check(0.9, 2.9)["checks"][0]["outcome"], "undecided");
    EXPECT_EQ(check(3.1, 10)["checks"][0]["outcome"], "failed");
    EXPECT_EQ(check(0.1, 0.9)["verdict"], "failed");

    // Three rounds give no interval.
    for (MethodResult& result : runs[0].results) result.samples.resize(3);
    runs[0].baseline_again.resize(3);
    EXPECT_EQ(check(0.9, 3)["checks"][0]["reason"], "there are too few rounds for an interval");
}

TEST_F(ReportFixture, OutliersAreMarkedAndKept) {
    runs[0].results[1].samples[2] = sample(900, 810);
    const json timing = report()["runs"][0]["results"][1]["timing"];
    EXPECT_EQ(timing["outliers"], json({2}));
    EXPECT_EQ(timing["samples"], json({5.0, 10.0, 900.0, 20.0, 25.0, 30.0}));
}

TEST_F(ReportFixture, FragmentsAreSummedAndEfficiencyIsIdealOverActualTime) {
    json fragments = report()["runs"][0]["results"][1]["fragments"];
    EXPECT_EQ(fragments["submitted"], 80);
    EXPECT_EQ(fragments["shaded"], 16);
    EXPECT_EQ(fragments["shaded_by"], "probed");
    EXPECT_EQ(fragments["visible"], 8);
    EXPECT_EQ(fragments["needed"], 16);
    EXPECT_TRUE(fragments["efficiency"].is_null());
    EXPECT_THAT(fragments["efficiency_reason"].get<std::string>(), HasSubstr("f2b"));

    // With b2f's times for f2b: 35 ms * 16 / 80 = 7 ms are ideal, 17.5 ms were measured.
    runs[0].results[0].method.id = "f2b";
    fragments = report()["runs"][0]["results"][1]["fragments"];
    EXPECT_DOUBLE_EQ(fragments["efficiency"].get<double>(), 0.4);
    EXPECT_FALSE(fragments.contains("efficiency_reason"));
    EXPECT_DOUBLE_EQ(report()["runs"][0]["results"][0]["fragments"]["efficiency"].get<double>(), 1);

    runs[0].results[1].fragments = {
        {{}, "why not shaded", "", {}, "why not visible", {}, "why no warps"}, {}, "why not needed", {}, 4};
    fragments = report()["runs"][0]["results"][1]["fragments"];
    for (const std::string name : {"shaded", "shaded_by", "visible", "needed", "efficiency", "warps", "live_warps",
                                   "quads", "live_quads", "model_speedup"})
        EXPECT_TRUE(fragments[name].is_null()) << name;
    EXPECT_EQ(fragments["shaded_reason"], "why not shaded");
    EXPECT_EQ(fragments["visible_reason"], "why not visible");
    EXPECT_EQ(fragments["needed_reason"], "why not needed");
    EXPECT_EQ(fragments["efficiency_reason"], "why not needed");
}

TEST_F(ReportFixture, CountPicturesShareAScaleAndGiveTheirGreatestValue) {
    const json images = report()["runs"][0]["results"][1]["images"];
    EXPECT_EQ(images["overdraw"]["greatest"], 10);
    EXPECT_EQ(images["shaded"]["greatest"], 2);
    EXPECT_EQ(images["saturation"]["greatest"], 2);
    for (const char* key : {"overdraw", "shaded", "saturation"}) EXPECT_EQ(images[key]["full_scale"], 10) << key;
    EXPECT_EQ(sink.bytes_by_name.at("2-F2BD--1-.shaded.png"),
              encode_png(count_picture({4, 2, std::vector<std::uint32_t>(8, 2)}, 10)));
    EXPECT_FALSE(report()["runs"][0]["results"][0]["images"].contains("saturation"));
}

/// A warp that starts costs one read, a live one four more: 10 + 4 * 10 of b2f over 10 + 4 * 2 of f2bd.
TEST_F(ReportFixture, TheModelComparesWhatWarpsCost) {
    for (auto& result : runs[0].results) result.fragments.reads = 4;
    runs[0].results[0].fragments.warps = {10, 10, 70, 70};
    runs[0].results[1].fragments.warps = {10, 2, 70, 12};
    const json fragments = report()["runs"][0]["results"][1]["fragments"];
    EXPECT_EQ(fragments["warps"], 10);
    EXPECT_EQ(fragments["live_warps"], 2);
    EXPECT_EQ(fragments["quads"], 70);
    EXPECT_EQ(fragments["live_quads"], 12);
    EXPECT_DOUBLE_EQ(fragments["model_speedup"].get<double>(), 50.0 / 18);
    EXPECT_EQ(report()["runs"][0]["results"][0]["fragments"]["model_speedup"], 1);

    runs[0].results[0].fragments.reads.reset();
    EXPECT_THAT(report()["runs"][0]["results"][1]["fragments"]["model_speedup_reason"].get<std::string>(),
                HasSubstr("of the baseline"));
}

TEST_F(ReportFixture, FragmentsCanBeChecked) {
    spec.checks = {{"fragments.shaded", "F2BD <1>", 16, 16},
                   {"fragments.efficiency", "F2BD <1>", 0, nullptr},
                   {"memory_bytes", "F2BD <1>", nullptr, 0}};
    const json checks = report()["checks"];
    EXPECT_EQ(checks[0]["passed"], true);
    EXPECT_EQ(checks[1]["passed"], false) << "unknown without f2b";
    EXPECT_EQ(checks[2]["passed"], true);
    const Spec parsed = parse_spec({{"scene", {{"type", "quads"}}},
                                    {"methods", {"f2b"}},
                                    {"checks", {{{"metric", "fragments.efficiency"}, {"method", "f2b"}, {"min", 0}}}}});
    EXPECT_EQ(parsed.checks[0].metric, "fragments.efficiency");
}

TEST_F(ReportFixture, AGpuIsTimedByItsOwnClockIfTheClocksAgree) {
    device.info.software = false;
    EXPECT_EQ(report()["runs"][0]["results"][0]["timing"]["clock"], "gpu");
    EXPECT_EQ(report()["runs"][0]["results"][0]["timing"]["median"], 9 * 3.5);
    runs[0].results[1].samples[0].valid = false;
    EXPECT_EQ(report()["runs"][0]["results"][0]["timing"]["clock"], "wall") << "one clock for all methods";
}

TEST_F(ReportFixture, MetricsAreSignedReferenceMinusMethod) {
    const json metrics = report()["runs"][0]["results"][1]["metrics"];
    EXPECT_EQ(metrics["signed"]["min"], -51);
    EXPECT_EQ(metrics["signed"]["max"], 0);
    EXPECT_DOUBLE_EQ(metrics["signed"]["mean_abs"], 51.0 / 24);
    EXPECT_EQ(metrics["worst_pixel"], json({2, 1}));
    EXPECT_TRUE(report()["runs"][0]["results"][0]["metrics"]["psnr"].is_null());
}

TEST_F(ReportFixture, ChecksCompareWithTheirLimits) {
    const json made = report();
    ASSERT_EQ(made["checks"].size(), 4u);
    EXPECT_EQ(made["checks"][0]["passed"], true);
    EXPECT_EQ(made["checks"][0]["value"], 2.0);
    EXPECT_EQ(made["checks"][1]["passed"], true);
    EXPECT_EQ(made["checks"][2]["passed"], true) << "identical pictures pass any least PSNR";
    EXPECT_EQ(made["checks"][3]["passed"], false) << "a value that was not measured passes no check";
    EXPECT_TRUE(made["checks"][3]["value"].is_null());
    EXPECT_EQ(made["checks"][3]["reason"], "unsupported: no <barrier>");
    EXPECT_TRUE(made["checks"][0]["reason"].is_null());
    EXPECT_EQ(made["verdict_reason"], "1 of 4 checks failed");
    EXPECT_EQ(made["verdict"], "failed");
}

TEST_F(ReportFixture, HasItsProvenanceAndTheMeaningOfItsNumbers) {
    device.info.name = "egl:1";
    device.info.gl_version = "4.6.0 NVIDIA 535.183.01";
    device.workarounds = {"flush-timer-queries"};
    runs[0].reference_findings = {{"lists", {{"kept", 80}}}};
    const json made = report();
    EXPECT_EQ(made["device"]["driver"], "NVIDIA 535.183.01");
    EXPECT_EQ(made["device"]["workarounds"], json({"flush-timer-queries"}));
    EXPECT_FALSE(made["device"]["cpu"].get<std::string>().empty());
    const json& provenance = made["provenance"];
    EXPECT_EQ(provenance["rerun"], "sheer compare SPEC.json --context egl --device egl:1");
    EXPECT_GT(provenance["cores"], 0);
    EXPECT_FALSE(provenance["version"].get<std::string>().empty());
    EXPECT_FALSE(provenance["commit"].get<std::string>().empty());
    for (const char* when : {"start", "end"}) EXPECT_EQ(provenance["load"][when].size(), 3u) << when;
    EXPECT_EQ(provenance["governor"].is_null(), provenance.contains("governor_reason"));
    EXPECT_THAT(made["color_space"]["blending"].get<std::string>(), HasSubstr("without conversion to linear light"));
    EXPECT_EQ(made["runs"][0]["reference"]["findings"]["lists"]["kept"], 80);

    device.info.gl_version = "4.6";
    const json unnamed = report()["device"];
    EXPECT_TRUE(unnamed["driver"].is_null());
    EXPECT_TRUE(unnamed.contains("driver_reason"));
}

TEST_F(ReportFixture, MissingMeasurementsAreNullWithAReason) {
    const json run = report()["runs"][0];
    EXPECT_TRUE(run["reference"]["residual"]["depth_peeling"].is_null());
    EXPECT_EQ(run["reference"]["residual_reason"], "too many");
    EXPECT_EQ(run["results"][2]["status"], "unsupported");
    EXPECT_EQ(run["results"][2]["reason"], "no <barrier>");
    EXPECT_TRUE(run["results"][2]["timing"].is_null());
    EXPECT_TRUE(run["results"][2]["metrics"].is_null());
    EXPECT_TRUE(run["results"][2]["speedup"].is_null());
}

TEST_F(ReportFixture, PicturesHaveNamesAndHashesOfTheirBytes) {
    const json images = report()["runs"][0]["results"][1]["images"];
    EXPECT_EQ(images["color"]["url"], "there/2-F2BD--1-.color.png");
    const std::string& bytes = sink.bytes_by_name.at("2-F2BD--1-.color.png");
    EXPECT_EQ(images["color"]["sha256"], sha256_hex(bytes));
    EXPECT_EQ(images["color"]["media_type"], "image/png");
    EXPECT_TRUE(images.contains("difference"));
    EXPECT_TRUE(images.contains("flip"));
    EXPECT_TRUE(sink.bytes_by_name.contains("reference-exact.linear.exr"));
}

TEST_F(ReportFixture, CountsBeyondTheColorsAreStoredAsNumbers) {
    EXPECT_FALSE(report()["runs"][0]["results"][1]["images"].contains("shaded_counts"));
    runs[0].results[1].fragments.shaded->counts[0] = 300;
    const json images = report()["runs"][0]["results"][1]["images"];
    EXPECT_EQ(images["shaded"]["full_scale"], 300);
    EXPECT_EQ(images["shaded_counts"]["media_type"], "image/x-exr");
    EXPECT_EQ(read_pixel(sink.bytes_by_name.at("2-F2BD--1-.shaded.exr"), 0, 0), (std::array<double, 3>{300, 0, 0}));
}

TEST_F(ReportFixture, LinearPicturesDoNotContainTheTime) {
    EXPECT_THAT(encode_exr(Image(2, 1)), HasSubstr("1970:01:01 00:00:00"));
}

/// 0.25 is 63.75 levels: rounded to 64, which is a quarter of a level off.
TEST_F(ReportFixture, GivesTheErrorOfTheFormatAlone) {
    for (std::size_t i = 0; i < runs[0].reference_image.rgba.size(); ++i) runs[0].reference_image.rgba[i] = 0.25f;
    runs[0].reference_as_shown = runs[0].reference_image;
    for (float& value : runs[0].reference_as_shown.rgba) value = 64 / 255.0f;
    runs[0].format_cost = compute_metrics(runs[0].reference_image, runs[0].reference_as_shown);
    const json made = report();
    const json& rounded = made["runs"][0]["reference"]["rounded"];
    EXPECT_EQ(rounded["label"], "exact in rgba8");
    EXPECT_EQ(rounded["format"], "rgba8");
    EXPECT_NEAR(rounded["metrics"]["linear"]["max_abs"].get<double>(), 0.25 / 255, 1e-7);
    EXPECT_EQ(rounded["metrics"]["differing_pixels"], 0);
    EXPECT_THAT(table_of(made), HasSubstr("exact in rgba8"));
}

TEST_F(ReportFixture, TableHasALineForEachMethodAndCheck) {
    const std::string table = table_of(report());
    EXPECT_THAT(table, HasSubstr("b2f           35.00"));
    EXPECT_THAT(table, HasSubstr("2.00x [2.00, 2.00]        faster"));
    EXPECT_THAT(table, HasSubstr("F2BD <1>         80      16        8      16           -"));
    EXPECT_LT(table.find("submitted"), table.find("median ms")) << "counts first on a software rasteriser";
    EXPECT_THAT(table, HasSubstr("6 of 10 rounds, ended by max_seconds."));
    EXPECT_THAT(table, HasSubstr("Noise floor, b2f against itself: 0.95x [0.95, 0.95]."));
    EXPECT_THAT(table, HasSubstr("f2bx      unsupported: no <barrier>"));
    EXPECT_THAT(table, HasSubstr("FAILED  rmse of f2bx is not measured, at most 1: unsupported: no <barrier>\n"));
    EXPECT_THAT(table, HasSubstr("do not predict"));
}

TEST_F(ReportFixture, JUnitCountsFailuresAndEscapes) {
    const std::string xml = junit_of(report());
    EXPECT_THAT(
        xml,
        HasSubstr("<testsuite name=\"A &amp; &quot;B&quot;\" tests=\"7\" failures=\"1\" errors=\"0\" skipped=\"1\""));
    EXPECT_THAT(xml, HasSubstr("name=\"speedup of F2BD &lt;1>\" />"));
    EXPECT_THAT(xml, HasSubstr("<skipped message=\"no &lt;barrier>\" />"));
    EXPECT_THAT(xml, Not(HasSubstr("<1>")));
    // 10, 20, ... 60 ms by the wall clock.
    EXPECT_THAT(xml, HasSubstr("name=\"renders b2f\" time=\"0.210\" />"));
    for (const char* property : {"spec_sha256", "verdict", "device", "version"})
        EXPECT_THAT(xml, HasSubstr(std::string("<property name=\"") + property + "\" value=\"")) << property;
}

/// A case keeps its history when somebody changes a limit.
TEST_F(ReportFixture, NamesInJUnitDoNotHaveTheLimits) {
    spec.checks = {{"flip.mean", "b2f", nullptr, 0.1, json::object()},
                   {"flip.mean", "b2f", 0.0, nullptr, json::object()},
                   {"rmse", "b2f", nullptr, 0.1, json::object()}};
    const auto names = [&] {
        const std::string xml = junit_of(report());
        EXPECT_THAT(xml, AllOf(HasSubstr("name=\"flip.mean of b2f\""), HasSubstr("name=\"flip.mean of b2f (2)\""),
                               HasSubstr("name=\"rmse of b2f\"")));
    };
    names();
    spec.checks[0].max = 0.2;
    names();
}

struct TemporaryFolder {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("sheer-report-test-" + std::to_string(getpid()));
    TemporaryFolder() { std::filesystem::create_directories(path); }
    ~TemporaryFolder() { std::filesystem::remove_all(path); }
};

TEST(PictureFile, PngKeepsEveryLevel) {
    Image8 image(16, 16);
    for (int i = 0; i < 256; ++i)
        for (int channel = 0; channel < 3; ++channel)
            image.pixel(i % 16, i / 16)[channel] = static_cast<std::uint8_t>(channel == 1 ? 255 - i : i);
    const TemporaryFolder folder;
    FolderSink sink(folder.path);
    const std::string bytes = encode_png(image);
    EXPECT_EQ(sink.put(sha256_hex(bytes), bytes, "ramp.png", "image/png"), "images/ramp.png");
    const Image8 read = read_png((folder.path / "images/ramp.png").string());
    EXPECT_EQ(read.width_px, 16);
    EXPECT_EQ(read.rgb, image.rgb);
}

TEST(PictureFile, MissingFileIsNamed) {
    try {
        read_png("no/such.png");
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(error.what(), HasSubstr("no/such.png"));
    }
}

TEST(ContentSinkTest, NamesFilesByContent) {
    const TemporaryFolder folder;
    ContentSink sink(folder.path, "/pictures");
    EXPECT_EQ(sink.put("abc", "bytes", "x.png", "image/png"), "/pictures/abc");
    std::ifstream file(folder.path / "abc");
    std::string text;
    file >> text;
    EXPECT_EQ(text, "bytes");
}

}  // namespace

}  // namespace sheer::report_test
