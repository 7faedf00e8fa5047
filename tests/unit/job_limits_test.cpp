#include "server/http/job_limits.h"

#include <gmock/gmock.h>

#include "renderer/spec/spec.h"

namespace sheer::http::job_limits_test {

namespace {

using nlohmann::json;

/// Two methods and the reference, 1 + 3 rounds of 1000 x 500 pixels.
json document() {
    return {{"image", {{"width", 1000}, {"height", 500}}},
            {"scene", {{"type", "quads"}}},
            {"methods", {"b2f", "f2b"}},
            {"timing", {{"warmup", 1}, {"rounds", 3}}}};
}

std::vector<std::string> pointers(const JobLimits& limits, const json& spec) {
    try {
        require_within(limits, parse_spec(spec));
    } catch (const SpecError& error) {
        std::vector<std::string> all;
        for (const FieldError& each : error.errors()) all.push_back(each.pointer);
        return all;
    }
    return {};
}

TEST(JobLimits, TheCostIsWhatIsDrawn) {
    EXPECT_DOUBLE_EQ(cost_mpx(parse_spec(document())), 0.5 * 3 * 4);
}

TEST(JobLimits, TheCostOfASweepIsThatOfItsPoints) {
    json spec = document();
    spec["sweep"] = {{{"pointer", "/image/width"}, {"values", {1000, 2000, 4000}}},
                     {{"pointer", "/scene/count"}, {"values", {3, 7}}}};
    EXPECT_DOUBLE_EQ(cost_mpx(parse_spec(spec)), (0.5 + 1 + 2) * 2 * 3 * 4);
}

TEST(JobLimits, EachLimitNamesItsField) {
    EXPECT_THAT(pointers({}, document()), testing::IsEmpty());
    EXPECT_THAT(pointers({.max_pixels = 500'000, .max_methods = 2, .max_points = 1, .max_cost = 6}, document()),
                testing::IsEmpty());
    EXPECT_THAT(pointers({.max_pixels = 499'999}, document()), testing::ElementsAre("/image"));
    EXPECT_THAT(pointers({.max_methods = 1}, document()), testing::ElementsAre("/methods"));
    EXPECT_THAT(pointers({.max_cost = 5}, document()), testing::ElementsAre(""));
    json spec = document();
    spec["sweep"] = {{{"pointer", "/image/width"}, {"values", {10, 2000}}}};
    EXPECT_THAT(pointers({.max_pixels = 500'000, .max_points = 1}, spec), testing::ElementsAre("/image", "/sweep"));
}

}  // namespace

}  // namespace sheer::http::job_limits_test
