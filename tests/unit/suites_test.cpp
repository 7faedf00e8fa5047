// The suites, and a report's section on one. Expected values are computed by hand from made-up runs.
#include "renderer/spec/suites.h"

#include <gmock/gmock.h>

#include <set>

#include "renderer/methods/shared/method.h"
#include "renderer/report/frontier.h"
#include "renderer/report/statistics.h"
#include "renderer/report/suite.h"
#include "renderer/results/quantity.h"
#include "renderer/spec/spec.h"

namespace sheer::suites_test {

namespace {

using nlohmann::json;
using testing::HasSubstr;

json result(const std::string& label, double speedup, double low, double high, double time_ms = 1, double error = 0) {
    return {{"label", label},
            {"status", "ok"},
            {"speedup", {{"value", speedup}, {"ci95", {low, high}}}},
            {"timing", {{"median", time_ms}, {"ci95", nullptr}}},
            {"metrics", {{"flip", {{"mean", error}}}}}};
}

json run(const json& point, const json& results) {
    return {{"point", point}, {"results", results}};
}

Suite suite(const json& trend) {
    Suite suite;
    suite.id = "test";
    suite.published =
        json::array({{{"at", {{"/scene/count", 16}}}, {"method", "f2bd"}, {"metric", "speedup"}, {"value", 1.06}}});
    suite.trends = json::array({trend});
    return suite;
}

json trend(const std::string& kind, const json& methods, const json& more = json::object()) {
    json trend = {{"text", "it is so"}, {"kind", kind}, {"metric", "speedup"}, {"methods", methods}};
    trend.update(more);
    return trend;
}

/// f2bd compared with f2b: clearly slower at 1 quad, not resolved at 16, clearly faster at 64.
const json runs = json::array(
    {run({{"/scene/count", 1}}, json::array({result("f2b", 0.9, 0.88, 0.92), result("f2bd", 0.5, 0.45, 0.55)})),
     run({{"/scene/count", 16}}, json::array({result("f2b", 1.0, 0.9, 1.1), result("f2bd", 1.05, 0.95, 1.2)})),
     run({{"/scene/count", 64}}, json::array({result("f2b", 1.0, 0.95, 1.05), result("f2bd", 2.0, 1.8, 2.2)}))});

json judged_suite(const Suite& suite, const json& of_runs) {
    return to_document(suite_report(suite, from_document<std::vector<report::Run>>(of_runs)));
}

std::string verdict(const json& judged_trend) {
    return judged_suite(suite(judged_trend), runs)["trends"][0]["verdict"];
}

json at(const std::vector<int>& counts) {
    json points = json::array();
    for (const int count : counts) points.push_back({{"/scene/count", count}});
    return {{"at", points}};
}

json frontier_of(const json& run, const std::string& baseline) {
    return to_document(frontier(from_document<report::Run>(run), baseline));
}

bool has_point(const Spec& spec, const json& at) {
    return std::ranges::any_of(spec.points, [&](const json& point) { return lies_at(point, at); });
}

bool has_method(const Spec& spec, const std::string& label) {
    return std::ranges::any_of(spec.methods, [&](const MethodSpec& method) { return method.label == label; });
}

TEST(Suites, AreTheSevenTablesOfThePaperAndHowCostsGrow) {
    std::size_t tables = 0;
    for (const Suite& one : all_suites()) {
        SCOPED_TRACE(one.id);
        const Spec spec = parse_spec(one.spec);
        EXPECT_EQ(spec.suite, one.id);
        if (one.published.empty()) {
            EXPECT_TRUE(one.id.starts_with("scaling-"));
            EXPECT_GE(spec.points.size(), 4u);
            for (const MethodInfo& method : all_methods()) EXPECT_TRUE(has_method(spec, method.id)) << method.id;
            continue;
        }
        ++tables;
        EXPECT_EQ(spec.image.width_px, 512);
        for (const json& figure : one.published) {
            EXPECT_TRUE(has_point(spec, figure["at"])) << figure.dump();
            EXPECT_TRUE(has_method(spec, figure["method"].get<std::string>())) << figure.dump();
            EXPECT_NE(find_quantity(figure["metric"]), nullptr) << figure.dump();
        }
        for (const json& judged : one.trends)
            for (const auto& method : judged["methods"])
                EXPECT_TRUE(has_method(spec, method.get<std::string>())) << judged.dump();
    }
    EXPECT_EQ(tables, 7u);
    EXPECT_EQ(all_suites().size(), 10u);
}

TEST(Suites, HaveThePublishedFigures) {
    const Suite* table1 = find_suite("Paper-Table-1");
    ASSERT_TRUE(table1);
    EXPECT_EQ(table1->published.size(), 33u);
    const json heaviest = {{"/scene/shading", "4x4-textures-math"}, {"/scene/texture/size", 1024}};
    double f2bx = 0;
    for (const json& figure : table1->published)
        if (figure["at"] == heaviest && figure["method"] == "f2bx") f2bx = figure["value"];
    EXPECT_EQ(f2bx, 41.55);
    EXPECT_EQ(find_suite("paper-table-8"), nullptr);
}

TEST(Suites, ScaleOnlyThePicture) {
    const Spec spec = parse_spec(suite_spec(*find_suite("paper-table-4"), 0.25));
    EXPECT_EQ(spec.image.width_px, 128);
    EXPECT_EQ(spec.image.height_px, 128);
    EXPECT_EQ(spec.scene["texture"]["size"], 1024);
    const Spec sizes = parse_spec(suite_spec(*find_suite("scaling-resolution"), 0.25));
    EXPECT_EQ(sizes.image.width_px, 64);
    EXPECT_EQ(sizes.points.back(), (json{{"/image/width", 1024}, {"/image/height", 1024}}));
    EXPECT_THROW(suite_spec(*find_suite("paper-table-4"), 0), std::invalid_argument);
    EXPECT_THROW(suite_spec(*find_suite("paper-table-4"), 1.5), std::invalid_argument);
}

TEST(Suites, UnknownOneIsRefused) {
    json spec = find_suite("paper-table-7")->spec;
    spec["suite"] = "paper-table-9";
    try {
        parse_spec(spec);
        FAIL();
    } catch (const SpecError& error) {
        EXPECT_EQ(error.errors()[0].pointer, "/suite");
    }
}

TEST(SuiteReport, SetsPublishedBesideMeasured) {
    const json figure = judged_suite(suite(trend("above", {"f2bd", "f2b"})), runs)["figures"][0];
    EXPECT_EQ(figure["published"], 1.06);
    EXPECT_EQ(figure["measured"], 1.05);
    EXPECT_EQ(figure["ci95"], json({0.95, 1.2}));
}

TEST(SuiteReport, MissingMeasurementsAreNull) {
    const json figure = judged_suite(suite(trend("above", {"f2bd", "f2b"})), json::array({runs[0]}))["figures"][0];
    EXPECT_TRUE(figure["measured"].is_null());
}

TEST(SuiteReport, AboveHoldsFailsOrIsOpen) {
    EXPECT_EQ(verdict(trend("above", {"f2bd", "f2b"}, at({64}))), "holds");
    EXPECT_EQ(verdict(trend("above", {"f2bd", "f2b"}, at({16, 64}))), "not resolved");
    EXPECT_EQ(verdict(trend("above", {"f2bd", "f2b"})), "fails");
    EXPECT_EQ(verdict(trend("above", {"f2bd", "b2f"})), "not resolved") << "b2f was not measured";
}

TEST(SuiteReport, TooFewSamplesForAnIntervalResolveNothing) {
    json few = runs[2];
    for (json& one : few["results"]) one["speedup"]["ci95"] = nullptr;
    const json made = judged_suite(suite(trend("above", {"f2bd", "f2b"})), json::array({few}));
    EXPECT_EQ(made["trends"][0]["verdict"], "not resolved");
    EXPECT_TRUE(made["figures"][0]["ci95"].is_null());
}

TEST(SuiteReport, GrowthIsJudgedBetweenEndsAndSteps) {
    EXPECT_EQ(verdict(trend("grows", {"f2bd"})), "holds");
    EXPECT_EQ(verdict(trend("grows", {"f2b"}, at({16, 64}))), "not resolved");
    EXPECT_EQ(verdict(trend("grows", {"f2bd"}, at({64, 1}))), "fails");
    EXPECT_EQ(verdict(trend("grows", {"f2bd"}, at({1, 64, 16}))), "fails") << "the last step is a resolved fall";
    EXPECT_EQ(verdict(trend("grows", {"f2bd"}, at({1}))), "not resolved");
}

TEST(SuiteReport, RangeHoldsForWholeIntervals) {
    EXPECT_EQ(verdict(trend("within", {"f2bd"}, {{"range", {0, 1}}, {"at", {{{"/scene/count", 1}}}}})), "holds");
    EXPECT_EQ(verdict(trend("within", {"f2bd"}, {{"range", {0, 1}}, {"at", {{{"/scene/count", 16}}}}})),
              "not resolved");
    EXPECT_EQ(verdict(trend("within", {"f2bd"}, {{"range", {0, 1}}})), "fails");
}

/// A method that takes `times` in ms, with the speedup that Timings would give it for the baseline `base`.
json timed(const std::string& label, const std::vector<double>& times, double error,
           const std::vector<double>& base = {100, 101, 102, 103, 104, 105, 106, 107, 108, 109}) {
    const Speedup judged = judge_speedup(paired_ratios(base, times), 4, NoiseFloor{1, {}, 1.05});
    return {{"label", label},
            {"status", "ok"},
            {"speedup",
             {{"value", judged.value},
              {"ci95", judged.ci95 ? json{judged.ci95->first, judged.ci95->second} : json()},
              {"verdict", word_of(judged.verdict)},
              {"compared", 4}}},
            {"timing", {{"median", median(times)}, {"samples", times}, {"ci95", nullptr}}},
            {"metrics", {{"flip", {{"mean", error}}}}}};
}

/// The baseline's times, each divided by its round's speed.
std::vector<double> at_speeds(const std::vector<double>& speeds) {
    std::vector<double> times;
    for (std::size_t i = 0; i < speeds.size(); ++i) times.push_back((100 + static_cast<double>(i)) / speeds[i]);
    return times;
}
std::vector<double> at_speed(double speed) {
    return at_speeds(std::vector(10, speed));
}
/// 1 within its interval.
const std::vector<double> as_fast = at_speeds({0.9, 1.1, 0.92, 1.12, 0.95, 1.08, 0.97, 1.2, 0.99, 1.01});

json timed_run(const json& results, int rounds = 10) {
    json all = run(json::object(), results);
    all["noise_floor"] = {{"factor", 1.05}};
    all["rounds"] = {{"asked", rounds}, {"done", rounds}, {"needed", 8}};
    return all;
}

TEST(Frontier, NamesDominatedMethodsAndTheDominatingOnes) {
    const json answer = frontier_of(
        timed_run({timed("b2f", at_speed(1), 0.0), timed("f2b", as_fast, 0.002), timed("f2bd", at_speed(4), 0.004),
                   timed("f2bd 0.5", at_speed(5), 0.2), timed("meshkin", at_speed(3), 0.3)}),
        "b2f");
    EXPECT_EQ(answer["methods"], json({"f2bd 0.5", "f2bd", "b2f"}));
    ASSERT_EQ(answer["dominated"].size(), 2u);
    EXPECT_EQ(answer["dominated"][0]["method"], "meshkin");
    EXPECT_EQ(answer["dominated"][0]["by"], "f2bd 0.5");
    EXPECT_EQ(answer["dominated"][0]["reason"], "f2bd 0.5 is resolved faster and not farther from the reference");
    EXPECT_EQ(answer["dominated"][1]["method"], "f2b");
    EXPECT_EQ(answer["dominated"][1]["reason"], "b2f is nearer to the reference, and f2b is not resolved faster");
    EXPECT_EQ(answer["fastest"], json({"f2bd 0.5"}));
    EXPECT_EQ(answer["fastest_under"], json::array({{{"error", 0.001}, {"method", nullptr}, {"tied", json::array()}},
                                                    {{"error", 0.01}, {"method", "f2bd"}, {"tied", json::array()}},
                                                    {{"error", 0.05}, {"method", "f2bd"}, {"tied", json::array()}}}));
    EXPECT_EQ(answer["closest_within"], json::array({{{"speed", 1.0}, {"method", "b2f"}, {"tied", json::array()}},
                                                     {{"speed", 2.0}, {"method", "f2bd"}, {"tied", json::array()}},
                                                     {{"speed", 4.0}, {"method", "f2bd"}, {"tied", json::array()}}}));
    EXPECT_THAT(answer["sentences"][0], HasSubstr("Under a mean FLIP error of 0.001 there is only b2f"));
    EXPECT_THAT(answer["sentences"][1],
                HasSubstr("Fastest under a mean FLIP error of 0.01: f2bd with an error of 0.004"));
    EXPECT_THAT(answer["sentences"][1], HasSubstr("[4.00, 4.00]"));
}

/// Like b2f but slower; what it gains is memory, or not.
TEST(Frontier, LeastMemoryIsAnAxisOfItsOwn) {
    const auto with_memory = [](json result, std::int64_t bytes) {
        result["memory_bytes"] = bytes;
        return result;
    };
    const json answer = frontier_of(timed_run({with_memory(timed("b2f", at_speed(1), 0.0), 0),
                                               with_memory(timed("quick", at_speed(4), 0.0), 8 << 20),
                                               with_memory(timed("slow", at_speed(0.5), 0.0), 4 << 20),
                                               with_memory(timed("greedy", at_speed(4), 0.0), 16 << 20),
                                               with_memory(timed("rough", at_speed(4), 0.03), 1 << 20)}),
                                    "b2f");
    EXPECT_EQ(answer["methods"], json({"quick", "rough", "b2f"}));
    ASSERT_EQ(answer["dominated"].size(), 2u);
    EXPECT_EQ(answer["dominated"][0],
              json({{"method", "greedy"},
                    {"by", "quick"},
                    {"reason",
                     "quick needs less memory, and greedy is neither resolved faster nor nearer to the reference"}}));
    EXPECT_EQ(answer["dominated"][1]["method"], "slow");
    EXPECT_EQ(answer["dominated"][1]["by"], "b2f");
    EXPECT_EQ(answer["least_memory_under"],
              json::array({{{"error", 0.001}, {"method", "b2f"}, {"tied", json::array()}, {"memory_bytes", 0}},
                           {{"error", 0.01}, {"method", "b2f"}, {"tied", json::array()}, {"memory_bytes", 0}},
                           {{"error", 0.05}, {"method", "b2f"}, {"tied", json::array()}, {"memory_bytes", 0}}}));
    EXPECT_EQ(answer["sentences"].back(),
              "Least memory under a mean FLIP error of 0.001: b2f, none beside the picture.");

    const json two = frontier_of(timed_run({with_memory(timed("b2f", at_speed(1), 0.002), 3 << 20),
                                            with_memory(timed("x", at_speed(1), 0.002), (3 << 20) + 100),
                                            with_memory(timed("y", at_speed(1), 0.02), 1 << 20)}),
                                 "b2f");
    EXPECT_EQ(two["least_memory_under"][0],
              json({{"error", 0.01}, {"method", "b2f"}, {"tied", {"x"}}, {"memory_bytes", 3 << 20}}));
    EXPECT_EQ(two["least_memory_under"][1]["method"], "y");
    EXPECT_EQ(two["sentences"].back(), "Least memory under a mean FLIP error of 0.05: y, 1 MiB.");
}

TEST(Frontier, CallsOnlyResolvedMethodsFastest) {
    const json answer = frontier_of(timed_run({timed("b2f", at_speed(1), 0.002), timed("f2b", as_fast, 0.004)}), "b2f");
    EXPECT_TRUE(answer["fastest"].empty());
    EXPECT_TRUE(answer["fastest_under"][0]["method"].is_null());
    for (const json& sentence : answer["sentences"])
        EXPECT_EQ(sentence.get<std::string>().find("Fastest"), std::string::npos) << sentence;
    EXPECT_THAT(answer["sentences"][0],
                HasSubstr("Under a mean FLIP error of 0.01 no method is resolved faster than b2f."));

    // Faster by 4 % with an interval beside 1, but two instances of the baseline differ by more.
    const json noise =
        frontier_of(timed_run({timed("b2f", at_speed(1), 0.0), timed("f2b", at_speed(1.04), 0.0)}), "b2f");
    EXPECT_TRUE(noise["fastest"].empty());
    EXPECT_TRUE(noise["dominated"].empty());
}

TEST(Frontier, TwoThatAreNotResolvedFromEachOtherAreFastestTogether) {
    // Both are twice as fast; round by round the lead alternates.
    const auto first = at_speeds({2, 2.2, 1.9, 2.1, 2.3, 1.8, 2, 2.2, 1.9, 2.1});
    const auto second = at_speeds({2.2, 2, 2.1, 1.9, 2, 2.2, 2.3, 1.8, 2.1, 1.9});
    const json answer = frontier_of(
        timed_run({timed("b2f", at_speed(1), 0.0), timed("x", first, 0.004), timed("y", second, 0.0041)}), "b2f");
    EXPECT_EQ(std::set<std::string>(answer["fastest"].begin(), answer["fastest"].end()),
              (std::set<std::string>{"x", "y"}));
    EXPECT_EQ(answer["fastest_under"][1]["tied"].size(), 1u);
    EXPECT_THAT(answer["sentences"][1], HasSubstr("; not resolved from it: "));
}

TEST(Frontier, TooFewRoundsAreReportedAndResolveNothing) {
    const std::vector<double> base = {100, 101, 102};
    const json answer =
        frontier_of(timed_run({timed("b2f", base, 0.0, base), timed("f2bd", {10, 10, 10}, 0.004, base)}, 3), "b2f");
    EXPECT_EQ(answer["sentences"], json::array({"No time is resolved, too few rounds: 3, needs 8."}));
    EXPECT_TRUE(answer["fastest"].empty());
}

TEST(Frontier, EqualsDoNotDominateEachOther) {
    const json twins = timed_run({timed("a", at_speed(1), 0.1), timed("b", at_speed(1), 0.1)});
    EXPECT_EQ(frontier_of(twins, "a")["methods"], json({"a", "b"}));
    // They differ in a digit that is not shown.
    const json near_twins = timed_run({timed("a", at_speed(1), 0.1001), timed("b", at_speed(1), 0.1002)});
    EXPECT_EQ(frontier_of(near_twins, "a")["methods"], json({"a", "b"}));
}

TEST(Frontier, NeedsTwoMethodsWithTimeAndError) {
    json bound = result("f2bx", 9, 8, 10);
    bound["metrics"] = nullptr;
    EXPECT_TRUE(frontier_of(run(json::object(), json::array({result("b2f", 1, 1, 1), bound})), "b2f").is_null());
}

}  // namespace

}  // namespace sheer::suites_test
