#include "renderer/report/statistics.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sheer {

double median(std::vector<double> samples) {
    if (samples.empty()) throw std::invalid_argument("the median of no samples");
    std::ranges::sort(samples);
    const std::size_t middle = samples.size() / 2;
    return samples.size() % 2 == 1 ? samples[middle] : (samples[middle - 1] + samples[middle]) / 2;
}

double percentile(std::vector<double> samples, double percent) {
    if (samples.empty()) throw std::invalid_argument("a percentile of no samples");
    std::ranges::sort(samples);
    const double rank = std::ceil(percent / 100 * static_cast<double>(samples.size()));
    return samples[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

std::optional<std::pair<double, double>> median_interval_95(std::vector<double> samples) {
    const std::size_t count = samples.size();
    // P(at most k of n samples lie under the median) under Binomial(n, 1/2), as logarithms: n may be 1000.
    double tail = 0;
    std::optional<std::size_t> rank;
    for (std::size_t k = 0; 2 * (k + 1) <= count; ++k) {
        const auto n = static_cast<double>(count), i = static_cast<double>(k);
        tail += std::exp(std::lgamma(n + 1) - std::lgamma(i + 1) - std::lgamma(n - i + 1) - n * std::log(2.0));
        if (tail > 0.025) break;
        rank = k;
    }
    if (!rank) return std::nullopt;
    std::ranges::sort(samples);
    return std::pair(samples[*rank], samples[count - 1 - *rank]);
}

Summary summarize(std::vector<double> samples) {
    Summary summary;
    summary.median = median(samples);
    std::vector<double> deviations;
    for (const double sample : samples) deviations.push_back(std::abs(sample - summary.median));
    summary.mad = median(deviations);
    summary.min = *std::ranges::min_element(samples);
    summary.p95 = percentile(samples, 95);
    summary.ci95 = median_interval_95(std::move(samples));
    return summary;
}

}  // namespace sheer
