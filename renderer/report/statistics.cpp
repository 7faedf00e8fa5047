#include "renderer/report/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace sheer {

namespace {

double median_deviation(const std::vector<double>& samples, double middle) {
    std::vector<double> deviations;
    for (const double sample : samples) deviations.push_back(std::abs(sample - middle));
    return median(deviations);
}

}  // namespace

double error_rate_of_look(int look) {
    return std::ldexp(full_error_rate, -look);
}

std::optional<report::Interval> interval_of(const std::optional<std::pair<double, double>>& pair) {
    return pair ? std::optional(report::Interval{pair->first, pair->second}) : std::nullopt;
}

double median(std::vector<double> samples) {
    if (samples.empty()) throw std::invalid_argument("there are no samples for the median");
    std::ranges::sort(samples);
    const std::size_t middle = samples.size() / 2;
    return samples.size() % 2 == 1 ? samples[middle] : (samples[middle - 1] + samples[middle]) / 2;
}

double percentile(std::vector<double> samples, double percent) {
    if (samples.empty()) throw std::invalid_argument("there are no samples for a percentile");
    std::ranges::sort(samples);
    const double rank = std::ceil(percent / 100 * static_cast<double>(samples.size()));
    return samples[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

std::optional<std::pair<double, double>> median_interval(std::vector<double> samples, double error_rate) {
    const std::size_t count = samples.size();
    // P(at most k of n samples lie under the median) under Binomial(n, 1/2), as logarithms: n may be 1000.
    double tail = 0;
    std::optional<std::size_t> rank;
    for (std::size_t k = 0; 2 * (k + 1) <= count; ++k) {
        const auto n = static_cast<double>(count), i = static_cast<double>(k);
        tail += std::exp(std::lgamma(n + 1) - std::lgamma(i + 1) - std::lgamma(n - i + 1) - n * std::log(2.0));
        if (tail > error_rate / 2) break;
        rank = k;
    }
    if (!rank) return std::nullopt;
    std::ranges::sort(samples);
    return std::pair(samples[*rank], samples[count - 1 - *rank]);
}

std::vector<std::size_t> outliers(const std::vector<double>& samples) {
    const double middle = median(samples), spread = median_deviation(samples, middle);
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < samples.size(); ++i)
        if (0.6745 * std::abs(samples[i] - middle) > 3.5 * spread) found.push_back(i);
    return found;
}

std::vector<double> paired_ratios(const std::vector<double>& baseline, const std::vector<double>& method) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < std::min(baseline.size(), method.size()); ++i)
        if (method[i] > 0) ratios.push_back(baseline[i] / method[i]);
    return ratios;
}

NoiseFloor noise_floor(const std::vector<double>& ratios) {
    NoiseFloor noise{median(ratios), median_interval(ratios, full_error_rate), 1};
    const auto [least, greatest] = std::ranges::minmax(ratios);
    const auto [low, high] = noise.ci95.value_or(std::pair(least, greatest));
    noise.factor = std::max({1.0, high, low > 0 ? 1 / low : std::numeric_limits<double>::infinity()});
    return noise;
}

Speedup judge_ratio(double value, const std::optional<std::pair<double, double>>& interval, double noise_factor,
                    const std::string& no_interval_reason) {
    Speedup speedup{value, interval, Verdict::not_resolved, ""};
    if (!interval) {
        speedup.reason = no_interval_reason;
    } else if (interval->first <= 1 && interval->second >= 1) {
        speedup.reason = "the interval contains 1";
    } else if (value <= noise_factor && value >= 1 / noise_factor) {
        speedup.reason = "inside the noise floor";
    } else {
        speedup.verdict = value > 1 ? Verdict::faster : Verdict::slower;
    }
    return speedup;
}

std::size_t rounds_needed(std::size_t compared, double error_rate) {
    // The widest pair of ranks, the least and the greatest sample, misses the median if all samples lie on one side of
    // it.
    std::size_t rounds = 1;
    double missed = 1;
    while (missed > error_rate / static_cast<double>(compared)) {
        ++rounds;
        missed /= 2;
    }
    return rounds;
}

Speedup judge_speedup(const std::vector<double>& ratios, std::size_t compared, const std::optional<NoiseFloor>& noise,
                      double error_rate) {
    return judge_ratio(median(ratios), median_interval(ratios, error_rate / static_cast<double>(compared)),
                       noise ? noise->factor : 1,
                       fmt::format("too few rounds: {}, needs {}", ratios.size(), rounds_needed(compared, error_rate)));
}

Summary summarize(std::vector<double> samples, double error_rate) {
    Summary summary;
    summary.median = median(samples);
    summary.mad = median_deviation(samples, summary.median);
    summary.min = *std::ranges::min_element(samples);
    summary.p95 = percentile(samples, 95);
    summary.ci95 = median_interval(std::move(samples), error_rate);
    return summary;
}

}  // namespace sheer
