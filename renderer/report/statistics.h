#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "renderer/results/report.h"

namespace sheer {

/// Of all looks together: an interval misses with at most this probability.
inline constexpr double full_error_rate = 0.05;

/// The error rate of one look at growing samples, from 1: alpha spending (Lan and DeMets, Discrete Sequential
/// Boundaries for Clinical Trials, 1983) that gives look k the share 2^-k. The shares of any number of looks add up to
/// less than full_error_rate, so by the union bound the intervals of all looks hold together with that rate, whatever
/// the looks depend on. 0: the samples are looked at once.
double error_rate_of_look(int look);

/// As reports have it.
std::optional<report::Interval> interval_of(const std::optional<std::pair<double, double>>& pair);

/// A summary of samples, in their unit.
struct Summary {
    double median = 0;
    double mad = 0;  ///< median absolute deviation from the median, unscaled
    double min = 0;
    double p95 = 0;                                 ///< nearest-rank 95th percentile
    std::optional<std::pair<double, double>> ci95;  ///< of the median; none if there are too few samples
};

/// Throws std::invalid_argument if there are no samples.
Summary summarize(std::vector<double> samples, double error_rate = full_error_rate);

double median(std::vector<double> samples);

/// Nearest-rank percentile: the least sample that at least `percent` % of all samples do not exceed. `percent` in (0,
/// 100].
double percentile(std::vector<double> samples, double percent);

/// Distribution-free interval for the median from order statistics (the sign test inverted; Conover, Practical
/// Nonparametric Statistics, section 3.2): the narrowest symmetric pair of ranks that misses the median with a
/// probability of at most `error_rate`, in (0, 1). None if there are too few samples for any pair to reach it: fewer
/// than 6 at 0.05.
std::optional<std::pair<double, double>> median_interval(std::vector<double> samples, double error_rate);

/// Indices of the samples that lie far from the rest: those whose modified z-score, 0.6745 |x - median| / MAD, is
/// over 3.5 (Iglewicz and Hoaglin, How to Detect and Handle Outliers, 1993). If the MAD is 0, all that differ from the
/// median.
std::vector<std::size_t> outliers(const std::vector<double>& samples);

/// The baseline's time over the method's, round by round, so that whatever slows down both cancels out. A round in
/// which the method took no time at all is left out.
std::vector<double> paired_ratios(const std::vector<double>& baseline, const std::vector<double>& method);

/// How much a method differs from itself: the ratios of two instances of the baseline, timed like any other two
/// methods.
struct NoiseFloor {
    double value = 1;                               ///< median ratio
    std::optional<std::pair<double, double>> ci95;  ///< of the median ratio
    /// Two instances of one method may differ by any ratio in [1 / factor, factor]. At least 1: taken from the end of
    /// `ci95` that is farther from 1, or, without an interval, from the ratios themselves.
    double factor = 1;
};

/// `ratios` must not be empty.
NoiseFloor noise_floor(const std::vector<double>& ratios);

using Verdict = report::SpeedVerdict;

/// The method compared with the baseline.
struct Speedup {
    double value = 1;  ///< median ratio
    /// Contains the median ratio; all compared methods' intervals together have 95 % confidence (Bonferroni).
    std::optional<std::pair<double, double>> ci95;
    Verdict verdict = Verdict::not_resolved;
    std::string reason;  ///< why it is not resolved
};

/// Resolved if the whole interval is on one side of 1, and the ratio is outside 1 / `noise_factor` to `noise_factor`.
/// `no_interval_reason` is the reason if there is no interval.
Speedup judge_ratio(double value, const std::optional<std::pair<double, double>>& interval, double noise_factor,
                    const std::string& no_interval_reason);

/// The fewest rounds that give judge_speedup() an interval.
std::size_t rounds_needed(std::size_t compared, double error_rate = full_error_rate);

/// `ratios` must not be empty; `compared`, at least 1, is the number of methods compared with the baseline.
Speedup judge_speedup(const std::vector<double>& ratios, std::size_t compared, const std::optional<NoiseFloor>& noise,
                      double error_rate = full_error_rate);

}  // namespace sheer
