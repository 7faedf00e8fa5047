#pragma once
#include <cstddef>
#include <vector>

#include "renderer/results/quantity.h"

namespace sheer {

/// The values between two change points: their median, and the medians of the ends of their intervals.
struct Level {
    std::size_t begin = 0, end = 0;  ///< indices of the series
    double median = 0, low = 0, high = 0;
};

struct ChangePoint {
    std::size_t index = 0;  ///< the first value of the new level
    Level before, after;
    double p = 0;  ///< how often a random order of the values around it looks changed as much
};

/// Where the level of a series changes: E-divisive (Matteson, James, "A Nonparametric Approach for Multiple Change
/// Point Analysis of Multivariate Data", JASA 109, 2014) with the exponent 1. The candidate is the split of a part of
/// the series with the greatest energy distance between its sides (the right one ends with the part, or after a power
/// of two of values), and it counts if at most one of 399 random orders of the 100 values on each side of it has as
/// great a distance; then its sides are split again. A change also must not be within the uncertainty: if the values
/// have intervals, those of the two levels may not overlap.
///
/// Takes n log^2 n steps for each part. The same series gives the same points.
std::vector<ChangePoint> change_points(const std::vector<Measured>& series);

}  // namespace sheer
