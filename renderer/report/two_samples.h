#pragma once
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "renderer/report/statistics.h"

namespace sheer {

/// The ratio of the samples of one set to those of another.
struct RatioOfSamples {
    double value = 1;
    std::optional<std::pair<double, double>> ci95;  ///< none if there are too few samples for the error rate
};

/// Hodges-Lehmann estimate of the ratio and the interval that inverts the Mann-Whitney test (Hollander, Wolfe,
/// Nonparametric Statistical Methods, section 4.2-4.3): the median of all ratios a / b, and the ranks among them that
/// miss the ratio with a probability of at most `error_rate`, in (0, 1). It assumes that the sets differ by a factor
/// and are drawn independently, and nothing about their distribution. Only positive samples count; throws
/// std::invalid_argument if either set has none.
RatioOfSamples ratio_of_samples(const std::vector<double>& a, const std::vector<double>& b, double error_rate);

/// The greatest k such that the Mann-Whitney statistic of sets of these sizes, drawn from one distribution, is at most
/// k with a probability of at most `probability`; none if there is no such k. Exact up to 1000 pairs, the normal
/// approximation above.
std::optional<std::size_t> mann_whitney_rank(std::size_t count_a, std::size_t count_b, double probability);

/// Whether the times `b` are shorter than the times `a`; the value is a's time over b's. `compared`, at least 1, is the
/// number of such comparisons made together (Bonferroni); a ratio within 1 / `noise_factor` to `noise_factor` is never
/// resolved.
Speedup judge_two_samples(const std::vector<double>& a, const std::vector<double>& b, std::size_t compared,
                          double noise_factor);

}  // namespace sheer
