// The terminal's table of a sweep: each line of a check names its point, and the end names the points at which a method
// is resolved.
#include "renderer/report/sweep_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/report/check_text.h"

namespace sheer::sweep_table_test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

json result(const std::string& label, double ratio, const std::string& verdict) {
    return {{"label", label}, {"status", "ok"}, {"speedup", {{"value", ratio}, {"verdict", verdict}}}};
}

json run_at(int count, const json& results) {
    return {{"point", {{"/scene/count", count}}}, {"results", results}};
}

report::Report report_of(const json& runs) {
    return from_document<report::Report>(
        {{"spec", {{"baseline", "b2f"}, {"methods", {{{"label", "b2f"}}, {{"label", "f2bd"}}, {{"label", "f2bx"}}}}}},
         {"runs", runs}});
}

TEST(SweepTable, HasALineForEachPointAndNamesResolvedPoints) {
    const json base = result("b2f", 1, "not resolved");
    const json missing = {{"label", "f2bx"}, {"status", "unsupported"}, {"speedup", nullptr}};
    const std::string table = sweep_table(report_of({run_at(1, {base, result("f2bd", 0.8, "slower"), missing}),
                                                     run_at(64, {base, result("f2bd", 1.04, "not resolved"), missing}),
                                                     run_at(256, {base, result("f2bd", 1.41, "faster"), missing}),
                                                     run_at(1024, {base, result("f2bd", 12, "faster"), missing})}));
    EXPECT_EQ(table,
              "\nspeedup at           f2bd         f2bx\n"
              "count 1      0.80x slower  unsupported\n"
              "count 64            1.04x  unsupported\n"
              "count 256    1.41x faster  unsupported\n"
              "count 1024  12.00x faster  unsupported\n"
              "\nBeside b2f:\n"
              "f2bd is faster at count 256; count 1024. It is slower at count 1.\n"
              "f2bx is not resolved to be faster or slower at any point.\n");
}

TEST(SweepTable, OnePointNeedsNone) {
    EXPECT_EQ(sweep_table(report_of(json::array({run_at(1, json::array({result("b2f", 1, "not resolved")}))}))), "");
    EXPECT_EQ(sweep_table(report_of(json::array())), "");
}

TEST(CheckText, NamesThePointAndShowsOnWhichSideOfTheLimitItIs) {
    json check = {{"metric", "flip.mean"}, {"method", "f2bd"}, {"at", {{"/scene/count", 16}, {"/image/width", 64}}},
                  {"min", nullptr},        {"max", 0.05},      {"value", 0.01736245740856606},
                  {"passed", true}};
    const auto typed = [&check] { return from_document<report::Check>(check); };
    EXPECT_EQ(check_name(typed()), "flip.mean of f2bd at width 64, count 16");
    EXPECT_EQ(check_value(typed()), "0.0174");
    check["value"] = 0.0500004;
    EXPECT_EQ(check_value(typed()), "0.0500004");
    check["value"] = nullptr;
    check["passed"] = false;
    EXPECT_EQ(check_value(typed()), "not measured");
    check["min"] = 1000000;
    EXPECT_EQ(check_limits(typed()), " at least 1000000 at most 0.05");
}

}  // namespace
}  // namespace sheer::sweep_table_test
