#include "renderer/report/qualification.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "renderer/spec/spec.h"
#include "temporary_folder.h"

namespace sheer::qualification_test {
namespace {

using enum report::SpeedVerdict;

report::Result timed(const std::string& label, double speedup, report::SpeedVerdict verdict) {
    report::Result result;
    result.label = label;
    result.speedup.value = report::Speedup{.value = speedup, .verdict = verdict};
    return result;
}

report::Report with(std::vector<report::Result> results) {
    report::Report report;
    report.device.emplace();
    report.device->renderer = "one";
    report.device->cpu = "two";
    report.runs.emplace_back();
    report.runs[0].results = std::move(results);
    return report;
}

TEST(Qualification, TheSpecIsValidAndItsSlowdownsAreKnown) {
    const nlohmann::json spec = qualification_spec(64, 20);
    EXPECT_NO_THROW(parse_spec(spec));
    ASSERT_EQ(spec["methods"].size(), 9U);
    EXPECT_NE(spec["scene"]["shading"]["glsl"].get<std::string>().find("i < 200;"), std::string::npos);
    EXPECT_NE(spec["methods"][3]["shading"]["glsl"].get<std::string>().find("i < 202;"), std::string::npos);
    EXPECT_NE(spec["methods"][8]["shading"]["glsl"].get<std::string>().find("i < 300;"), std::string::npos);
}

TEST(Qualification, CountsVerdicts) {
    QualificationTally tally;
    tally.add(with({timed("b2f", 1, not_resolved), timed("same", 1, faster), timed("same again", 1, not_resolved),
                    timed("5 % slower", 0.8, not_resolved), timed("10 % slower", 0.8, slower),
                    timed("20 % slower", 0.5, slower), timed("50 % slower", 0.5, slower)}));
    tally.add(with({timed("same", 1, not_resolved), timed("same again", 1, slower), timed("10 % slower", 0.8, faster),
                    timed("20 % slower", 0.5, slower), timed("50 % slower", 0.5, slower)}));
    const report::Qualification result = tally.result("then");
    EXPECT_EQ(result.renderer, "one");
    EXPECT_EQ(result.comparisons, 4);
    EXPECT_EQ(result.false_changes, 2);
    EXPECT_EQ(result.false_change_rate, 0.5);
    ASSERT_EQ(result.slowdowns.size(), 4U);
    EXPECT_EQ(result.slowdowns[0].found, 0);
    EXPECT_EQ(result.slowdowns[0].comparisons, 1);
    EXPECT_EQ(result.slowdowns[1].found, 0.5);
    EXPECT_EQ(result.slowdowns[1].slowdown, 1.25);
    EXPECT_EQ(result.found_from, 2.0);
    EXPECT_NE(qualification_table(result).find("2 times in 4: 50.0 %"), std::string::npos);
}

TEST(Qualification, WithoutTimesThereIsNone) {
    QualificationTally tally;
    EXPECT_THROW(tally.result("then"), std::runtime_error);
    tally.add(with({}));
    EXPECT_THROW(tally.result("then"), std::runtime_error);
}

// Values from Brown, Cai, DasGupta: Interval Estimation for a Binomial Proportion, formula 4, worked out by hand.
TEST(Qualification, WilsonsInterval) {
    const report::Interval none = wilson_interval(0, 10);
    EXPECT_NEAR(none[0], 0, 1e-12);
    EXPECT_NEAR(none[1], 0.27753, 1e-4);
    const report::Interval half = wilson_interval(50, 100);
    EXPECT_NEAR(half[0], 0.40383, 1e-4);
    EXPECT_NEAR(half[1], 0.59617, 1e-4);
}

TEST(Qualification, TheLastOneOfEachDeviceIsKept) {
    const test::TemporaryFolder folder;
    const auto file = folder.path() / "deep" / "qualifications.json";
    report::Device device;
    device.renderer = "one";
    device.cpu = "two";
    EXPECT_FALSE(last_qualification(file, device));
    for (const char* at : {"1", "2"}) keep_qualification(file, {.at = at, .renderer = "one", .cpu = "two"});
    keep_qualification(file, {.at = "3", .renderer = "other", .cpu = "two"});
    EXPECT_EQ(last_qualification(file, device)->at, "2");
    std::ofstream(file) << "no JSON";
    EXPECT_FALSE(last_qualification(file, device));
    keep_qualification(file, {.at = "4", .renderer = "one", .cpu = "two"});
    EXPECT_EQ(last_qualification(file, device)->at, "4");
    EXPECT_THROW(keep_qualification({}, {}), std::runtime_error);
}

}  // namespace
}  // namespace sheer::qualification_test
