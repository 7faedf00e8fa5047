#include "renderer/litmus/formula.h"

#include <algorithm>
#include <cmath>

namespace sheer::litmus {

namespace {

/// The staircase of the absorbance over depth, averaged over cells. No wavelets are needed for that: the projection on
/// the Haar basis of 2^(rank + 1) functions is the mean over as many cells.
class Staircase {
  public:
    Staircase(const Stack& stack, int cells, double greatest) : m_means(static_cast<std::size_t>(cells)) {
        for (const Fragment& fragment : stack.fragments) {
            const double absorbance = fragment.alpha < 1 ? std::min(greatest, -std::log(1 - fragment.alpha)) : greatest;
            for (int cell = 0; cell < cells; ++cell)
                mean_over(cell) += absorbance * std::clamp(cell + 1 - place(fragment), 0.0, 1.0);
        }
    }

    double transmittance_before(const Fragment& fragment) {
        const int cell = std::min(static_cast<int>(place(fragment)), static_cast<int>(m_means.size()) - 1);
        const double along = place(fragment) - cell, before = cell > 0 ? mean_over(cell - 1) : 0;
        return std::exp(-((1 - along) * before + along * mean_over(cell)));
    }

  private:
    double place(const Fragment& fragment) const { return fragment.depth * (static_cast<double>(m_means.size()) - 1); }
    double& mean_over(int cell) { return m_means[static_cast<std::size_t>(cell)]; }

    std::vector<double> m_means;
};

Formula weighted_by_staircase(const nlohmann::json& parameters) {
    return [=](const Stack& stack) {
        Staircase staircase(stack, 2 << parameters.value("rank", 3), parameters.value("greatest_absorbance", 10.0));
        Color sum = {};
        double weights = 0, transmittance = 1;
        for (const Fragment& fragment : stack.fragments) {
            const double weight = fragment.alpha * staircase.transmittance_before(fragment);
            for (std::size_t i = 0; i < 3; ++i) sum[i] += weight * fragment.color[i];
            weights += weight;
            transmittance *= 1 - fragment.alpha;
        }
        if (weights == 0) return stack.below;
        for (double& channel : sum) channel /= weights;
        return mix(sum, stack.below, transmittance);
    };
}

}  // namespace

FormulaInfo formula_wavelet() {
    return {.id = "wavelet",
            .name = "wavelet transparency",
            .make = weighted_by_staircase,
            .variants = {{{"rank", 1}}, {{"rank", 2}}, {{"rank", 3}}, {{"rank", 4}}}};
}

}  // namespace sheer::litmus
