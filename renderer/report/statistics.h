#pragma once
#include <optional>
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
/// Nonparametric Statistics, section 3.2): the narrowest symmetric pair of ranks whose coverage is at least 95 %.
/// None for fewer than 6 samples, where no pair reaches it.
std::optional<std::pair<double, double>> median_interval_95(std::vector<double> samples);

}  // namespace sheer
