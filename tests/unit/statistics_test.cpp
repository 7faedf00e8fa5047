// The statistics of a comparison's samples. Noise comes from a seeded generator, so that each test gives the same
// answer every time.
#include "renderer/report/statistics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "renderer/core/random.h"

namespace sheer::statistics_test {

namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(Statistics, OfSevenByHand) {
    // Sorted 1 2 3 4 5 6 20: median 4, deviations 0 1 1 2 2 3 16 with median 2, 95 % of 7 is rank 7.
    const Summary summary = summarize({5, 1, 20, 4, 3, 6, 2});
    EXPECT_EQ(summary.median, 4);
    EXPECT_EQ(summary.mad, 2);
    EXPECT_EQ(summary.min, 1);
    EXPECT_EQ(summary.p95, 20);
    // 2 / 2^7 = 1.6 % lies outside the whole range, 2 (1 + 7) / 2^7 = 12.5 % outside the second to sixth.
    ASSERT_TRUE(summary.ci95.has_value());
    EXPECT_EQ(*summary.ci95, std::pair(1.0, 20.0));
}

TEST(Statistics, OfTenByHand) {
    const std::vector<double> samples = {10, 9, 8, 7, 6, 5, 4, 3, 2, 1};
    // 2 (1 + 10) / 2^10 = 2.1 % outside ranks 2 to 9, 2 (1 + 10 + 45) / 2^10 = 10.9 % outside 3 to 8.
    EXPECT_EQ(median_interval(samples, 0.05), std::pair(2.0, 9.0));
    // For three methods 5 % / 3 = 1.67 % are allowed, so it takes the whole range, which is missed in 0.2 %.
    EXPECT_EQ(median_interval(samples, 0.05 / 3), std::pair(1.0, 10.0));
    // 26 methods allow 0.192 %, less than 2 / 2^10 = 0.195 %.
    EXPECT_EQ(median_interval(samples, 0.05 / 26), std::nullopt);
    EXPECT_EQ(median(samples), 5.5);
    EXPECT_EQ(percentile(samples, 95), 10);
    EXPECT_EQ(percentile(samples, 50), 5);
}

TEST(Statistics, FiveSamplesGiveNoInterval) {
    // 2 / 2^5 = 6.25 % outside even the whole range.
    EXPECT_EQ(median_interval({1, 2, 3, 4, 5}, 0.05), std::nullopt);
    EXPECT_THROW(summarize({}), std::invalid_argument);
}

/// Ranks 40 to 61 of 100 contain the median with 96.5 % (tables of the sign test).
TEST(Statistics, OfAHundred) {
    std::vector<double> samples;
    for (int i = 1; i <= 100; ++i) samples.push_back(i);
    EXPECT_EQ(median_interval(samples, 0.05), std::pair(40.0, 61.0));
}

TEST(Outliers, ByHand) {
    // Median 10, deviations 0 1 1 2 2 10 6: MAD 2. A score of 3.5 is a deviation of 2 * 3.5 / 0.6745 = 10.38.
    EXPECT_THAT(outliers({8, 9, 20, 10, 11, 12, 4}), IsEmpty());
    EXPECT_THAT(outliers({8, 9, 20.4, 10, 11, 12, -0.5}), ElementsAre(2, 6));
    EXPECT_THAT(outliers({5, 5, 5, 5.001, 5}), ElementsAre(3));
    EXPECT_THAT(outliers({5}), IsEmpty());
}

TEST(PairedRatios, AreOfTheSameRound) {
    EXPECT_THAT(paired_ratios({10, 30, 7}, {5, 10, 7}), ElementsAre(2, 3, 1));
    EXPECT_THAT(paired_ratios({10, 30, 7}, {5, 0}), ElementsAre(2));
}

TEST(NoiseFloor, ReachesToTheFartherEnd) {
    // For six samples the interval is the whole range: 0.8 is 1.25 times away from 1, 1.1 only 1.1 times.
    const NoiseFloor noise = noise_floor({0.8, 0.9, 1, 1, 1.05, 1.1});
    EXPECT_EQ(noise.value, 1);
    EXPECT_EQ(noise.ci95, std::pair(0.8, 1.1));
    EXPECT_DOUBLE_EQ(noise.factor, 1.25);
    // Two rounds have no interval, so only the ratios are used.
    EXPECT_EQ(noise_floor({1.02, 1.5}).ci95, std::nullopt);
    EXPECT_DOUBLE_EQ(noise_floor({1.02, 1.5}).factor, 1.5);
    // An interval beside 1: the two instances differ, so 1.1 is within the noise.
    EXPECT_DOUBLE_EQ(noise_floor({1.1, 1.1, 1.1, 1.1, 1.1, 1.1}).factor, 1.1);
}

TEST(Verdict, NeedsAnIntervalBesideOneAndBeyondTheNoise) {
    const std::vector<double> faster = {1.3, 1.3, 1.31, 1.32, 1.35, 1.36};
    EXPECT_EQ(judge_speedup(faster, 1, std::nullopt).verdict, Verdict::faster);
    EXPECT_EQ(judge_speedup(faster, 1, NoiseFloor{1, {}, 1.3}).verdict, Verdict::faster);
    const Speedup noise = judge_speedup(faster, 1, NoiseFloor{1, {}, 1.4});
    EXPECT_EQ(noise.verdict, Verdict::not_resolved);
    EXPECT_EQ(noise.reason, "inside the noise floor");
    EXPECT_EQ(noise.ci95, std::pair(1.3, 1.36));

    const std::vector<double> slower = {0.5, 0.5, 0.5, 0.6, 0.6, 0.9};
    EXPECT_EQ(judge_speedup(slower, 1, NoiseFloor{1, {}, 1.5}).verdict, Verdict::slower);
    EXPECT_EQ(judge_speedup(slower, 1, NoiseFloor{1, {}, 2}).verdict, Verdict::not_resolved);

    // Two methods allow 2.5 % each, less than the 2 / 2^6 = 3.1 % of six rounds.
    EXPECT_EQ(judge_speedup(faster, 2, std::nullopt).reason, "too few rounds: 6, needs 7");
    EXPECT_EQ(judge_speedup({0.9, 1.2, 1.2, 1.2, 1.2, 1.2}, 1, std::nullopt).reason, "the interval contains 1");
    EXPECT_EQ(judge_speedup({1, 1, 1, 1, 1, 1}, 1, std::nullopt).verdict, Verdict::not_resolved);
}

TEST(Verdict, RoundsNeededAreTheFewestWithAnInterval) {
    // 2 / 2^n at most 5 % of `compared`.
    const std::pair<std::size_t, std::size_t> by_hand[] = {{1, 6}, {2, 7}, {3, 7}, {4, 8}, {6, 8}, {7, 9}, {25, 10}};
    for (const auto& [compared, rounds] : by_hand) EXPECT_EQ(rounds_needed(compared), rounds) << compared;
    for (std::size_t compared = 1; compared < 40; ++compared) {
        const std::size_t rounds = rounds_needed(compared);
        EXPECT_TRUE(judge_speedup(std::vector(rounds, 2.0), compared, {}).ci95.has_value()) << compared;
        EXPECT_FALSE(judge_speedup(std::vector(rounds - 1, 2.0), compared, {}).ci95.has_value()) << compared;
    }
}

/// A kind of noise: the measured time of a frame in `round` whose true time is 1.
struct Noise {
    const char* name;
    std::function<double(std::mt19937_64&, int round)> time;
};

double normal(std::mt19937_64& random) {
    return std::normal_distribution<double>()(random);
}

std::vector<Noise> noises() {
    return {
        {"log-normal", [](std::mt19937_64& random, int) { return std::exp(0.1 * normal(random)); }},
        {"one frame in ten takes up to many times as long",
         [](std::mt19937_64& random, int) {
             const double time = std::exp(0.03 * normal(random));
             return random() % 10 == 0 ? time * (1 + std::abs(std::cauchy_distribution<double>(0, 1)(random))) : time;
         }},
        {"a clock that slows down by half, and oscillates",
         [](std::mt19937_64& random, int round) {
             return (1 + 0.05 * round + 0.3 * std::sin(round)) * std::exp(0.05 * normal(random));
         }},
    };
}

/// Times of `methods` + 2 contenders, in rounds: the baseline, its second instance, then the methods.
std::vector<std::vector<double>> rounds(const Noise& noise, int methods, int count, std::mt19937_64& random) {
    std::vector<std::vector<double>> times(static_cast<std::size_t>(methods) + 2);
    for (int round = 0; round < count; ++round)
        for (auto& samples : times) samples.push_back(noise.time(random, round));
    return times;
}

std::vector<Verdict> verdicts(const std::vector<std::vector<double>>& times) {
    const NoiseFloor noise = noise_floor(paired_ratios(times[0], times[1]));
    std::vector<Verdict> all;
    for (std::size_t i = 2; i < times.size(); ++i)
        all.push_back(judge_speedup(paired_ratios(times[0], times[i]), times.size() - 2, noise).verdict);
    return all;
}

/// In 95 of 100 comparisons nothing at all may be resolved, however many methods there are.
TEST(Verdict, IdenticalMethodsAreNotResolved) {
    constexpr int trials = 1000;
    for (const Noise& noise : noises()) {
        for (const int methods : {1, 4, 8}) {
            for (const int count : {10, 30}) {
                std::mt19937_64 random(1);
                int quiet = 0;
                for (int trial = 0; trial < trials; ++trial) {
                    const auto all = verdicts(rounds(noise, methods, count, random));
                    quiet += std::ranges::all_of(all, [](Verdict one) { return one == Verdict::not_resolved; });
                }
                EXPECT_GE(quiet, trials * 95 / 100) << noise.name << ", " << methods << " methods, " << count;
            }
        }
    }
}

/// The same without the noise floor: the correction for the number of methods must suffice, and an uncorrected interval
/// must not, or this test would show nothing.
TEST(Verdict, TheCorrectionIsNeededAndEnough) {
    constexpr int trials = 1000, methods = 8, count = 30;
    std::mt19937_64 random(2);
    int corrected = 0, uncorrected = 0;
    for (int trial = 0; trial < trials; ++trial) {
        const auto times = rounds(noises()[0], methods, count, random);
        bool any_corrected = false, any_uncorrected = false;
        for (std::size_t i = 2; i < times.size(); ++i) {
            const auto ratios = paired_ratios(times[0], times[i]);
            any_corrected |= judge_speedup(ratios, methods, std::nullopt).verdict != Verdict::not_resolved;
            any_uncorrected |= judge_speedup(ratios, 1, std::nullopt).verdict != Verdict::not_resolved;
        }
        corrected += any_corrected;
        uncorrected += any_uncorrected;
    }
    EXPECT_LE(corrected, trials * 5 / 100);
    EXPECT_GT(uncorrected, trials * 10 / 100);
}

TEST(Verdict, FindsADifferenceOf30Percent) {
    constexpr int trials = 200;
    for (const Noise& noise : noises()) {
        std::mt19937_64 random(3);
        int faster = 0, slower = 0;
        for (int trial = 0; trial < trials; ++trial) {
            auto times = rounds(noise, 2, 30, random);
            for (double& time : times[2]) time /= 1.3;
            for (double& time : times[3]) time *= 1.3;
            const auto all = verdicts(times);
            faster += all[0] == Verdict::faster;
            slower += all[1] == Verdict::slower;
        }
        EXPECT_GE(faster, trials * 95 / 100) << noise.name;
        EXPECT_GE(slower, trials * 95 / 100) << noise.name;
    }
}

TEST(Verdict, TheIntervalContainsTheTrueRatio) {
    constexpr int trials = 1000;
    for (const Noise& noise : noises()) {
        std::mt19937_64 random(4);
        int held = 0;
        for (int trial = 0; trial < trials; ++trial) {
            auto times = rounds(noise, 1, 20, random);
            for (double& time : times[2]) time /= 1.3;
            const auto ci95 = judge_speedup(paired_ratios(times[0], times[2]), 1, std::nullopt).ci95;
            ASSERT_TRUE(ci95.has_value());
            held += ci95->first <= 1.3 && 1.3 <= ci95->second;
        }
        EXPECT_GE(held, trials * 94 / 100) << noise.name;
    }
}

TEST(Looks, AllTogetherSpendNoMoreThanTheFullRate) {
    EXPECT_EQ(error_rate_of_look(0), 0.05);
    EXPECT_EQ(error_rate_of_look(1), 0.025);
    EXPECT_EQ(error_rate_of_look(3), 0.00625);
    double spent = 0;
    for (int look = 1; look <= 16; ++look) spent += error_rate_of_look(look);
    EXPECT_LT(spent, 0.05);
    // 2 * 2^-6 is over 0.025 and 2 * 2^-7 is not; one look at 0.05 needs 6.
    EXPECT_EQ(rounds_needed(1, error_rate_of_look(1)), 7u);
    EXPECT_EQ(rounds_needed(1), 6u);
}

/// Ratios whose median is 1, looked at after 10, 20, ... 320 of them: how often any interval excludes 1.
double share_of_wrong_decisions(bool spends) {
    constexpr int trials = 2000;
    Random random(7);
    int wrong = 0;
    for (int trial = 0; trial < trials; ++trial) {
        std::vector<double> ratios;
        bool is_wrong = false;
        for (int look = 1; look <= 6; ++look) {
            while (ratios.size() < (std::size_t{5} << look)) ratios.push_back(0.5 + random.unit());
            const auto interval = median_interval(ratios, error_rate_of_look(spends ? look : 0));
            is_wrong |= interval && (interval->first > 1 || interval->second < 1);
        }
        wrong += is_wrong;
    }
    return static_cast<double>(wrong) / trials;
}

TEST(Looks, TheErrorRateHoldsHoweverOftenItIsLookedAt) {
    EXPECT_LT(share_of_wrong_decisions(true), 0.05);
    EXPECT_GT(share_of_wrong_decisions(false), 0.07) << "without alpha spending it would not hold";
}

}  // namespace

}  // namespace sheer::statistics_test
