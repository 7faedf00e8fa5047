#include "renderer/report/growth.h"

#include <gtest/gtest.h>

#include "renderer/report/sweep_table.h"

namespace sheer::growth_test {
namespace {

using nlohmann::json;

TEST(PowerLaw, IsFoundExactly) {
    const auto root = fit_power_law({{1, 3}, {4, 6}, {16, 12}});
    ASSERT_TRUE(root);
    EXPECT_NEAR(root->exponent, 0.5, 1e-12);
    EXPECT_NEAR(root->ci95.second - root->ci95.first, 0, 1e-6);
    EXPECT_NEAR(fit_power_law({{8, 128}, {2, 8}, {4, 32}})->exponent, 2, 1e-12);
}

// Computed with Python from the formulas of a regression, with the t of R's qt(0.975, 2).
TEST(PowerLaw, HasAnIntervalByTheScatter) {
    const auto law = fit_power_law({{1, 3}, {2, 5}, {4, 9}, {8, 20}});
    ASSERT_TRUE(law);
    EXPECT_NEAR(law->exponent, 0.9058894, 1e-6);
    EXPECT_NEAR(law->ci95.first, 0.617496, 1e-4);
    EXPECT_NEAR(law->ci95.second, 1.194283, 1e-4);
}

TEST(PowerLaw, NeedsThreePointsAboveZero) {
    EXPECT_FALSE(fit_power_law({{1, 1}, {2, 2}}));
    EXPECT_FALSE(fit_power_law({{0, 1}, {2, 2}, {3, 3}}));
    EXPECT_FALSE(fit_power_law({{1, 1}, {2, 0}, {3, 3}}));
    EXPECT_FALSE(fit_power_law({{2, 1}, {2, 2}, {2, 3}}));
}

// From R's qt(0.975, df).
TEST(StudentT, IsThatOfTheTables) {
    EXPECT_NEAR(student_t95(1), 12.7062, 1e-4);
    EXPECT_NEAR(student_t95(30), 2.042272, 1e-4);
    EXPECT_NEAR(student_t95(31), 2.039513, 1e-4);
    EXPECT_NEAR(student_t95(100), 1.983972, 1e-4);
}

report::Run run_at(const json& point, double b2f_ms, double f2b_ms) {
    report::Run run;
    run.point = point;
    for (const auto& [label, ms] : {std::pair("b2f", b2f_ms), std::pair("f2b", f2b_ms)}) {
        report::Result result{.method = label, .label = label};
        result.timing.emplace().median = ms;
        result.memory_bytes = static_cast<std::int64_t>(1000 * b2f_ms * b2f_ms);
        run.results.push_back(result);
    }
    return run;
}

TEST(Growth, IsOfEachFieldAndMethodAtTheOthersValues) {
    std::vector<report::Run> runs;
    for (const int size : {10, 20})
        for (const int count : {1, 2, 4})
            runs.push_back(run_at({{"/scene/count", count}, {"/scene/shading", "constant"}, {"/image/width", size}},
                                  size * count, 5.0 * count * count));
    const json sweep = {{{"pointer", "/image/width"}, {"values", {10, 20}}},
                        {{"pointer", "/scene/count"}, {"values", {1, 2, 4}}},
                        {{"pointer", "/scene/shading"}, {"values", {"constant"}}}};
    const std::vector<report::Growth> growth = growth_of(sweep, runs);
    ASSERT_EQ(growth.size(), 8) << "times and memory of two methods; two sizes are too few";
    EXPECT_EQ(growth.back().metric, "memory_bytes");
    EXPECT_NEAR(growth.back().exponent, 2, 1e-12);
    const auto& last = growth[3];
    EXPECT_EQ(last.metric, "timing.median");
    EXPECT_EQ(last.pointer, "/scene/count");
    EXPECT_EQ(last.at, (json{{"/scene/shading", "constant"}, {"/image/width", 20}}));
    EXPECT_EQ(last.method, "f2b");
    EXPECT_NEAR(last.exponent, 2, 1e-12);
    EXPECT_NEAR(growth.front().exponent, 1, 1e-12);
    EXPECT_EQ(last.points, 3);
}

TEST(Growth, OfFieldsThatAreSetTogetherIsThatOfTheFirst) {
    std::vector<report::Run> runs;
    json points = json::array();
    for (const int size : {256, 512, 1024}) {
        points.push_back({{"/image/width", size}, {"/image/height", size}});
        runs.push_back(run_at(points.back(), size * size, 7));
    }
    const std::vector<report::Growth> growth = growth_of(json::array({{{"points", points}}}), runs);
    ASSERT_EQ(growth.size(), 4);
    EXPECT_EQ(growth[0].pointer, "/image/height");
    EXPECT_EQ(growth[0].at, json::object());
    EXPECT_NEAR(growth[0].exponent, 2, 1e-12);
    EXPECT_NEAR(growth[1].exponent, 0, 1e-12);
    points[1]["/image/width"] = "wide";
    EXPECT_TRUE(growth_of(json::array({{{"points", points}}}), runs).empty()) << "not all are numbers";
}

TEST(Growth, IsToldOnTheTerminal) {
    report::Report report;
    report.spec = {{"methods", json::array({{{"label", "b2f"}}})}};
    const std::string time = "timing.median", memory = "memory_bytes";
    report.growth = {{time, "/scene/count", {{"/image/width", 10}}, "b2f", 0.984, {0.91, 1.06}, 4},
                     {time, "/scene/count", {{"/image/width", 10}}, "f2b", 1.5, {1.25, 1.75}, 4},
                     {time, "/image/width", json::object(), "b2f", 2, {2, 2}, 3},
                     {memory, "/image/width", json::object(), "b2f", 0, {0, 0}, 3},
                     {memory, "/image/width", json::object(), "exact", 2, {2, 2}, 3}};
    EXPECT_EQ(sweep_table(report),
              "At width 10, time grows as count^p, p = 0.98 [0.91, 1.06] for b2f, 1.50 [1.25, 1.75] for f2b.\n"
              "Time grows as width^p, p = 2.00 [2.00, 2.00] for b2f.\n"
              "Memory grows as width^p, p = 2.00 [2.00, 2.00] for exact.\n");
}

}  // namespace
}  // namespace sheer::growth_test
