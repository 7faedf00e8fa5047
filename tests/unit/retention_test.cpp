#include "server/jobs/retention.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sheer::test::retention_test {
namespace {

constexpr std::int64_t day_ms = 86'400'000, now_ms = 1000 * day_ms;

/// Reports of the last days, one a day, newest first: "0" is of today.
std::vector<StoredReport> days(int count, const nlohmann::json& tags = nlohmann::json::object()) {
    std::vector<StoredReport> all;
    for (int i = 0; i < count; ++i)
        all.push_back({.id = std::to_string(i), .created_ms = now_ms - i * day_ms, .tags = tags, .bytes = 100});
    return all;
}

std::string pruned(const std::vector<StoredReport>& reports, const std::vector<RetentionRule>& rules) {
    std::string ids;
    for (const PrunedReport& report : reports_to_prune(reports, rules, now_ms))
        ids += (ids.empty() ? "" : " ") + report.id;
    return ids;
}

TEST(Retention, IsByAgeCountAndSize) {
    EXPECT_EQ(pruned(days(5), {}), "");
    EXPECT_EQ(pruned(days(5), {{.max_age_days = 2}}), "4 3");
    EXPECT_EQ(pruned(days(5), {{.max_reports = 4}}), "4");
    EXPECT_EQ(pruned(days(5), {{.max_reports = 0}}), "4 3 2 1 0");
    EXPECT_EQ(pruned(days(5), {{.max_bytes = 250}}), "4 3 2");
    EXPECT_EQ(pruned(days(5), {{.max_bytes = 500}}), "");
    EXPECT_EQ(pruned(days(5), {{.max_age_days = 3, .max_reports = 2, .max_bytes = 400}}), "4 3 2");
}

TEST(Retention, NothingOlderIsKeptAfterOneThatDoesNotFit) {
    auto reports = days(4);
    reports[1].bytes = 1000;
    EXPECT_EQ(pruned(reports, {{.max_bytes = 500}}), "3 2 1");
}

TEST(Retention, PinnedAndAcceptedReportsAreKeptAndDoNotCount) {
    auto reports = days(5);
    reports[0].is_kept = reports[4].is_kept = true;
    EXPECT_EQ(pruned(reports, {{.max_reports = 2}}), "3");
    EXPECT_EQ(pruned(reports, {{.max_age_days = 1}}), "3 2");
}

TEST(Retention, TheFirstRuleWithATagOfTheReportDecides) {
    auto reports = days(6, {{"branch", "main"}});
    reports[1].tags = {{"branch", "topic"}};
    reports[3].tags = {{"branch", "topic"}};
    reports[5].tags = nlohmann::json::object();
    EXPECT_EQ(pruned(reports, {{.tag = "branch:topic", .max_reports = 1}}), "3");
    EXPECT_EQ(pruned(reports, {{.tag = "branch:main", .max_reports = 10}, {.max_age_days = 0}}), "5 3 1");
    EXPECT_EQ(pruned(reports, {{.tag = "branch", .max_reports = 4}, {.max_reports = 0}}), "5 4");
    EXPECT_EQ(pruned(reports, {{.tag = "bran", .max_reports = 0}}), "");
}

TEST(Retention, SaysWhy) {
    const auto all = reports_to_prune(days(3, {{"a", "b"}}), {{.tag = "a:b", .max_age_days = 1.5}}, now_ms);
    ASSERT_EQ(all.size(), 1u);
    EXPECT_EQ(all[0].reason, "a:b: older than 1.5 days");
    EXPECT_EQ(all[0].bytes, 100u);
}

}  // namespace
}  // namespace sheer::test::retention_test
