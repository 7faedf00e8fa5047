#include "renderer/report/two_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sheer {

namespace {

constexpr double two_sample_error_rate = 0.05;
constexpr std::size_t max_exact_pairs = 1000;

/// P(U = u) for sets of m and n values. The greatest value of all belongs to the first set with probability m / (m +
/// n), and then exceeds all n of the other, which leaves sets of m - 1 and n.
std::vector<double> mann_whitney_probabilities(std::size_t m, std::size_t n) {
    std::vector<std::vector<double>> row(n + 1, std::vector<double>(m * n + 1, 0.0));
    for (std::size_t j = 0; j <= n; ++j) row[j][0] = 1;
    for (std::size_t i = 1; i <= m; ++i) {
        for (std::size_t j = 1; j <= n; ++j) {
            const double of_first = static_cast<double>(i) / static_cast<double>(i + j);
            for (std::size_t u = i * j + 1; u-- > 0;)
                row[j][u] = (u >= j ? of_first * row[j][u - j] : 0) + (1 - of_first) * row[j - 1][u];
        }
    }
    return row[n];
}

std::optional<std::size_t> exact_rank(std::size_t m, std::size_t n, double probability) {
    std::optional<std::size_t> rank;
    double tail = 0;
    const std::vector<double> probabilities = mann_whitney_probabilities(m, n);
    for (std::size_t k = 0; k < probabilities.size(); ++k) {
        tail += probabilities[k];
        if (tail > probability) break;
        rank = k;
    }
    return rank;
}

std::optional<std::size_t> approximate_rank(std::size_t m, std::size_t n, double probability) {
    const double pairs = static_cast<double>(m) * static_cast<double>(n);
    const double deviation = std::sqrt(pairs * static_cast<double>(m + n + 1) / 12);
    std::optional<std::size_t> rank;
    // Bisects for the first k that is too probable: the probability grows with k.
    std::size_t low = 0, high = m * n / 2 + 1;
    while (low < high) {
        const std::size_t k = (low + high) / 2;
        const double z = (static_cast<double>(k) + 0.5 - pairs / 2) / deviation;
        if (std::erfc(-z / std::sqrt(2.0)) / 2 <= probability) {
            rank = k;
            low = k + 1;
        } else {
            high = k;
        }
    }
    return rank;
}

std::vector<double> logarithms(const std::vector<double>& samples) {
    std::vector<double> all;
    for (const double sample : samples)
        if (sample > 0) all.push_back(std::log(sample));
    if (all.empty()) throw std::invalid_argument("no positive samples");
    return all;
}

double ranked(std::vector<double>& values, std::size_t rank) {
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(rank);
    std::ranges::nth_element(values, place);
    return *place;
}

/// The smallest size of two equally large sets that gives an interval.
std::size_t two_sample_rounds_needed(double rate) {
    std::size_t rounds = 1;
    while (!mann_whitney_rank(rounds, rounds, rate / 2)) ++rounds;
    return rounds;
}

}  // namespace

std::optional<std::size_t> mann_whitney_rank(std::size_t count_a, std::size_t count_b, double probability) {
    return count_a * count_b <= max_exact_pairs ? exact_rank(count_a, count_b, probability)
                                                : approximate_rank(count_a, count_b, probability);
}

RatioOfSamples ratio_of_samples(const std::vector<double>& a, const std::vector<double>& b, double rate) {
    const std::vector<double> of_a = logarithms(a), of_b = logarithms(b);
    std::vector<double> ratios;
    ratios.reserve(of_a.size() * of_b.size());
    for (const double one : of_a)
        for (const double other : of_b) ratios.push_back(one - other);
    const std::size_t count = ratios.size();
    RatioOfSamples ratio;
    ratio.value = std::exp((ranked(ratios, (count - 1) / 2) + ranked(ratios, count / 2)) / 2);
    if (const auto rank = mann_whitney_rank(of_a.size(), of_b.size(), rate / 2))
        ratio.ci95.emplace(std::exp(ranked(ratios, *rank)), std::exp(ranked(ratios, count - 1 - *rank)));
    return ratio;
}

Speedup judge_two_samples(const std::vector<double>& a, const std::vector<double>& b, std::size_t compared,
                          double noise_factor) {
    const double rate = two_sample_error_rate / static_cast<double>(compared);
    const RatioOfSamples ratio = ratio_of_samples(a, b, rate);
    return judge_ratio(ratio.value, ratio.ci95, noise_factor,
                       fmt::format("too few rounds: {} and {}, needs {} in both reports", a.size(), b.size(),
                                   two_sample_rounds_needed(rate)));
}

}  // namespace sheer
