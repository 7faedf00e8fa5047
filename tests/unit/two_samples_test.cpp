#include "renderer/report/two_samples.h"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

namespace sheer::two_samples_test {
namespace {

using Times = std::vector<double>;

TEST(MannWhitneyRank, MatchesTheTables) {
    // 3 and 3 values have 20 orders: U is 0 in one of them, 1 in one.
    EXPECT_EQ(mann_whitney_rank(3, 3, 0.0499), std::nullopt);
    EXPECT_EQ(mann_whitney_rank(3, 3, 0.0501), 0u);
    EXPECT_EQ(mann_whitney_rank(3, 3, 0.1001), 1u);
    // Critical values of the two-sided test at 5 % (Mann, Whitney, 1947, and textbooks since).
    EXPECT_EQ(mann_whitney_rank(5, 5, 0.025), 2u);
    EXPECT_EQ(mann_whitney_rank(8, 8, 0.025), 13u);
    EXPECT_EQ(mann_whitney_rank(10, 10, 0.025), 23u);
    EXPECT_EQ(mann_whitney_rank(6, 10, 0.025), 11u);
    EXPECT_EQ(mann_whitney_rank(10, 6, 0.025), 11u);
    EXPECT_EQ(mann_whitney_rank(20, 20, 0.025), 127u);
}

TEST(MannWhitneyRank, IsApproximatedForLargeSets) {
    // Exact values, from the coefficients of the Gaussian binomial in whole numbers.
    EXPECT_NEAR(static_cast<double>(mann_whitney_rank(40, 40, 0.025).value()), 596, 1);
    EXPECT_NEAR(static_cast<double>(mann_whitney_rank(100, 50, 0.025).value()), 2008, 2);
    // In its far tail the approximation is conservative.
    EXPECT_NEAR(static_cast<double>(mann_whitney_rank(40, 40, 0.0025).value()), 508.5, 1.5);
    EXPECT_EQ(mann_whitney_rank(1, 2000, 1e-9), std::nullopt);
}

TEST(RatioOfSamples, IsTheMedianOfAllRatios) {
    // 2/1 2/2 2/4, 4/1 4/2 4/4, 8/1 8/2 8/4: sorted 1/2 1 1 2 2 2 4 4 8.
    const RatioOfSamples ratio = ratio_of_samples({8, 2, 4}, {1, 4, 2}, 0.1001);
    EXPECT_DOUBLE_EQ(ratio.value, 2);
    ASSERT_TRUE(ratio.ci95);
    EXPECT_DOUBLE_EQ(ratio.ci95->first, 0.5);
    EXPECT_DOUBLE_EQ(ratio.ci95->second, 8);
    // The next rank is allowed 20 %: U of at most 1 at each end.
    const RatioOfSamples narrower = ratio_of_samples({8, 2, 4}, {1, 4, 2}, 0.2001);
    EXPECT_DOUBLE_EQ(narrower.ci95->first, 1);
    EXPECT_DOUBLE_EQ(narrower.ci95->second, 4);
    // An even count: the geometric mean of 1 and 4.
    EXPECT_DOUBLE_EQ(ratio_of_samples({4}, {1, 4}, 0.05).value, 2);
    EXPECT_FALSE(ratio_of_samples({4}, {1, 4}, 0.05).ci95);
}

TEST(RatioOfSamples, LeavesOutTimesOfZero) {
    EXPECT_DOUBLE_EQ(ratio_of_samples({0, 6}, {3, 0}, 0.05).value, 2);
    EXPECT_THROW(ratio_of_samples({0}, {1}, 0.05), std::invalid_argument);
    EXPECT_THROW(ratio_of_samples({1}, {}, 0.05), std::invalid_argument);
}

TEST(JudgeTwoSamples, UsesIntervalAndNoise) {
    const Times slow = {130, 131, 132, 133, 134, 135}, fast = {100, 101, 102, 103, 104, 105};
    EXPECT_EQ(judge_two_samples(slow, fast, 1, 1).verdict, Verdict::faster);
    EXPECT_EQ(judge_two_samples(fast, slow, 1, 1).verdict, Verdict::slower);
    EXPECT_EQ(judge_two_samples(slow, slow, 1, 1).verdict, Verdict::not_resolved);
    EXPECT_EQ(judge_two_samples(slow, fast, 1, 1.4).reason, "inside the noise floor");
    // The extreme order of 6 and 6 has the probability 1 / 924: 1 / 462 at both ends, too much for 5 % of 100. So has
    // that of 7 and 7 with 1 / 3432; that of 8 and 8 has 1 / 12870.
    EXPECT_EQ(judge_two_samples(slow, fast, 20, 1).verdict, Verdict::faster);
    EXPECT_EQ(judge_two_samples(slow, fast, 100, 1).reason, "too few rounds: 6 and 6, needs 8 in both reports");
}

/// Times around 10 ms, skewed and with a heavy tail.
Times draw(std::mt19937& random, std::size_t count, double factor) {
    std::lognormal_distribution<double> usual(std::log(10.0), 0.08);
    std::bernoulli_distribution disturbed(0.05);
    Times times;
    for (std::size_t i = 0; i < count; ++i) times.push_back(factor * usual(random) * (disturbed(random) ? 2.5 : 1));
    return times;
}

TEST(JudgeTwoSamples, ResolvesNothingForEqualMethodsAtLeast95TimesIn100) {
    std::mt19937 random(7);
    for (const std::size_t count : {6u, 10u, 40u}) {
        int resolved = 0;
        for (int i = 0; i < 1000; ++i) {
            const Times a = draw(random, count, 1), b = draw(random, count, 1);
            resolved += judge_two_samples(a, b, 1, 1).verdict != Verdict::not_resolved;
        }
        // 5 in 100, plus three standard deviations of such a count.
        EXPECT_LE(resolved, 50 + 21) << count;
        EXPECT_GE(resolved, 5) << "a test that never resolves anything would pass, too";
    }
}

TEST(JudgeTwoSamples, FindsAFactorOf13) {
    std::mt19937 random(8);
    int found = 0;
    for (int i = 0; i < 100; ++i) {
        const Speedup speedup = judge_two_samples(draw(random, 20, 1.3), draw(random, 20, 1), 3, 1.05);
        found += speedup.verdict == Verdict::faster;
        EXPECT_NE(speedup.verdict, Verdict::slower);
    }
    EXPECT_GE(found, 95);
}

}  // namespace
}  // namespace sheer::two_samples_test
