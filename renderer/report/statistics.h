#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sheer {

/// What a set of samples says. All in the unit of the samples.
struct Summary {
    double median = 0;
    double mad = 0;  ///< median absolute deviation from the median, unscaled
    double min = 0;
    double p95 = 0;                                 ///< nearest-rank 95th percentile
    std::optional<std::pair<double, double>> ci95;  ///< of the median; none where there are too few samples
};

/// Throws std::invalid_argument if there are no samples.
Summary summarize(std::vector<double> samples);

double median(std::vector<double> samples);

/// Nearest-rank percentile: the least sample that at least `percent` of all do not exceed. `percent` in (0, 100].
double percentile(std::vector<double> samples, double percent);

/// Distribution-free interval for the median from order statistics (the sign test inverted; Conover, Practical
/// Nonparametric Statistics, section 3.2): the narrowest symmetric pair of ranks that misses the median with a
/// probability of at most `error_rate`, in (0, 1). None where there are too few samples for any pair to reach it: fewer
/// than 6 at 0.05.
std::optional<std::pair<double, double>> median_interval(std::vector<double> samples, double error_rate);

/// Which samples lie far from the rest, by index: those whose modified z-score, 0.6745 |x - median| / MAD, is over 3.5
/// (Iglewicz and Hoaglin, How to Detect and Handle Outliers, 1993). Where the MAD is 0, all that are not the median.
std::vector<std::size_t> outliers(const std::vector<double>& samples);

/// Baseline's time over the method's, round by round: what slows both of them down cancels out. A round in which the
/// method took no time at all has no ratio and is left out.
std::vector<double> paired_ratios(const std::vector<double>& baseline, const std::vector<double>& method);

/// How far a method is from itself: the ratios of two instances of the baseline, timed like any other two methods.
struct NoiseFloor {
    double value = 1;                               ///< median ratio
    std::optional<std::pair<double, double>> ci95;  ///< of the median ratio
    /// A ratio in [1 / factor, factor] is no more than what two instances of one method may differ by. At least 1: the
    /// farther end of `ci95` from 1, or without an interval of the ratios themselves.
    double factor = 1;
};

/// `ratios` must not be empty.
NoiseFloor noise_floor(const std::vector<double>& ratios);

enum class Verdict { faster, slower, not_resolved };

/// The method against the baseline.
struct Speedup {
    double value = 1;  ///< median ratio
    /// Holds the median ratio with 95 % together with those of all methods compared (Bonferroni).
    std::optional<std::pair<double, double>> ci95;
    Verdict verdict = Verdict::not_resolved;
    std::string reason;  ///< why not resolved
};

/// "faster", "slower" or "not resolved".
const char* verdict_name(Verdict verdict);

/// Resolved is what lies to one side of 1 with its whole interval, and outside 1 / `noise_factor` to `noise_factor`.
/// `no_interval_reason` is the reason where there is no interval.
Speedup judge_ratio(double value, const std::optional<std::pair<double, double>>& interval, double noise_factor,
                    const std::string& no_interval_reason);

/// The fewest rounds that give judge_speedup() an interval.
std::size_t rounds_needed(std::size_t compared);

/// `ratios` must not be empty; `compared` is how many methods, from 1, are held against the baseline.
Speedup judge_speedup(const std::vector<double>& ratios, std::size_t compared, const std::optional<NoiseFloor>& noise);

}  // namespace sheer
