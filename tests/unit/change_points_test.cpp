#include "renderer/report/change_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "renderer/core/random.h"

namespace sheer::test::change_points_test {
namespace {

/// Values around levels, each with an interval of this half width; 0 for exact values.
std::vector<Measured> series(const std::vector<std::pair<double, int>>& levels, double noise, double half_width = 0,
                             std::uint64_t seed = 1) {
    Random random(seed);
    std::vector<Measured> all;
    for (const auto& [level, count] : levels)
        for (int i = 0; i < count; ++i) {
            // The sum of twelve is nearly normal with the deviation 1.
            double sum = -6;
            for (int j = 0; j < 12; ++j) sum += random.unit();
            const double value = level + noise * sum;
            all.push_back({value, value - half_width, value + half_width});
        }
    return all;
}

std::vector<std::size_t> indices(const std::vector<Measured>& values) {
    std::vector<std::size_t> all;
    for (const ChangePoint& point : change_points(values)) all.push_back(point.index);
    return all;
}

using Indices = std::vector<std::size_t>;

TEST(ChangePoints, AreWhereTheLevelChanges) {
    EXPECT_EQ(indices(series({{10, 20}, {12, 20}}, 0)), (Indices{20}));
    EXPECT_EQ(indices(series({{10, 30}, {20, 10}, {10, 30}}, 0.5)), (Indices{30, 40}));
    const auto points = change_points(series({{10, 8}, {12, 9}}, 0));
    ASSERT_EQ(points.size(), 1u);
    EXPECT_EQ(points[0].before.median, 10);
    EXPECT_EQ(points[0].after.median, 12);
    EXPECT_EQ(points[0].before.begin, 0u);
    EXPECT_EQ(points[0].after.end, 17u);
    EXPECT_LE(points[0].p, 0.01);
}

TEST(ChangePoints, NeedEnoughValues) {
    EXPECT_EQ(indices({}), Indices{});
    EXPECT_EQ(indices(series({{10, 1}}, 0)), Indices{});
    EXPECT_EQ(indices(series({{10, 2}, {20, 2}}, 0)), Indices{});
    // The 20 ways to choose 3 of 6 are too few for a probability of 0.01.
    EXPECT_EQ(indices(series({{10, 3}, {20, 3}}, 0)), Indices{});
    EXPECT_EQ(indices(series({{10, 4}, {20, 4}}, 0)), Indices{});
    EXPECT_EQ(indices(series({{10, 8}, {20, 8}}, 0)), (Indices{8}));
}

TEST(ChangePoints, AreNotFoundInEqualValuesAndRarelyInNoise) {
    EXPECT_EQ(indices(series({{10, 500}}, 0)), Indices{});
    int found = 0;
    for (std::uint64_t seed = 0; seed < 100; ++seed) found += !indices(series({{10, 40}}, 1, 0, seed)).empty();
    // One in a hundred is expected.
    EXPECT_LE(found, 5);
}

TEST(ChangePoints, OfUncertainValuesNeedIntervalsThatDoNotOverlap) {
    EXPECT_EQ(indices(series({{10, 20}, {12, 20}}, 0.1, 0.9)), (Indices{20}));
    EXPECT_EQ(indices(series({{10, 20}, {12, 20}}, 0.1, 1.2)), Indices{});
    // The intervals of the outer levels do, those of the inner ones do not.
    EXPECT_EQ(indices(series({{10, 20}, {10.5, 20}, {14, 20}}, 0.05, 0.9)), (Indices{40}));
}

/// The definition of a split of the whole series, in n^3 steps: Matteson and James 2014, equations 5 to 7.
std::size_t split_by_definition(const std::vector<Measured>& all) {
    double best = -1;
    std::size_t at = 0;
    for (std::size_t split = 3; split + 3 <= all.size(); ++split) {
        const auto n = static_cast<double>(split), m = static_cast<double>(all.size() - split);
        double between = 0, left = 0, right = 0;
        for (std::size_t i = 0; i < all.size(); ++i)
            for (std::size_t j = i + 1; j < all.size(); ++j) {
                const double distance = std::abs(all[i].value - all[j].value);
                (j < split ? left : i >= split ? right : between) += distance;
            }
        const double energy = 2 / (n * m) * between - left / (n * (n - 1) / 2) - right / (m * (m - 1) / 2);
        if (const double weighted = n * m / (n + m) * energy; weighted > best) {
            best = weighted;
            at = split;
        }
    }
    return at;
}

TEST(ChangePoints, AreThoseOfTheDefinition) {
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        const auto values = series({{10, 25}, {13, 17}}, 1, 0, seed);
        const auto found = change_points(values);
        ASSERT_FALSE(found.empty()) << seed;
        const bool is_there = std::ranges::any_of(
            found, [&](const ChangePoint& point) { return point.index == split_by_definition(values); });
        EXPECT_TRUE(is_there) << seed;
    }
}

TEST(ChangePoints, OfALongSeriesAreFound) {
    const Indices found = indices(series({{10, 3000}, {11, 3000}, {10, 4000}}, 0.2));
    EXPECT_EQ(std::ranges::count(found, 3000u), 1);
    EXPECT_EQ(std::ranges::count(found, 6000u), 1);
    // With a probability of 0.005 for each part, there may be a few more.
    EXPECT_LE(found.size(), 4u);
}

}  // namespace
}  // namespace sheer::test::change_points_test
