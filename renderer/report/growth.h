#pragma once
#include <optional>
#include <utility>
#include <vector>

#include "renderer/results/report.h"

namespace sheer {

/// y = a x^exponent.
struct PowerLaw {
    double exponent = 0;
    std::pair<double, double> ci95;  ///< contains the exponent if the logarithms scatter normally about the line
};

/// Least squares of log y on log x, with Student's t for the interval. `points` are pairs (x, y). None for fewer than
/// three, if a coordinate is not above 0, or if all x are equal.
std::optional<PowerLaw> fit_power_law(const std::vector<std::pair<double, double>>& points);

/// Student's t with `degrees` of freedom, at least 1, is beyond +- this with a probability of 5 %.
double student_t95(std::size_t degrees);

/// How the median times and the memory of the methods grow along each axis of `sweep`, a spec's, that sets numbers. If
/// an axis sets several fields together, the first one stands for it.
std::vector<report::Growth> growth_of(const nlohmann::json& sweep, const std::vector<report::Run>& runs);

}  // namespace sheer
