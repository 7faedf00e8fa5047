#include "tests/render/method_row.h"

#include <algorithm>
#include <cmath>

namespace sheer::test {

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

/// Everything is summed in 32-bit floats, n roundings of an absorbance of up to n; the opaque picture and the result
/// are rounded.
double staircase_bound(const Stack& stack, PixelFormat format) {
    const double in_floats = rounded_once(stack, PixelFormat::rgba32f);
    return format == PixelFormat::rgba32f ? in_floats : in_floats + 1.01 * step_of(format);
}

}  // namespace

MethodRow row_wavelet() {
    return {
        .id = "wavelet",
        .formula = weighted_by_staircase,
        .weighs_depths = true,
        .variants = {{nlohmann::json::object(), staircase_bound},
                     {{{"rank", 1}}, staircase_bound},
                     {{{"rank", 4}}, staircase_bound},
                     {{{"rank", 2}, {"greatest_absorbance", 2}}, staircase_bound}},
        .litmus =
            {{"",
              {nlohmann::json::object()},
              {{{"shuffled"}, passes, "coefficients are sums, which do not depend on the order, except for rounding"},
               {{"unequal"},
                fails,
                "the layer of 0.7 lies in the middle of a cell and so takes a quarter of its own absorbance as being "
                "in front of it, which the others do not"},
               {{"window"},
                fails,
                "so does the first leaf, whose absorbance is 10: a quarter of it hides the leaf from itself, and the "
                "glass in front gets its weight"},
               {{"close_pair"}, fails, "both layers of the pair are in one cell and show equally"},
               {{"interleaved"}, passes, "sixteen layers in sixteen cells, whose staircase is nearly a slope"},
               {{"black", "white", "checker", "alpha_to_1"},
                passes,
                "each layer has a cell of its own and lies at the border of one (0.1 of the depth is one and a half of "
                "16 cells), or the nearest hides all others by a factor of over 100"},
               {{"alpha_to_0"}, passes, "faint layers hardly hide each other"},
               {{"glass"},
                fails,
                "near the intersection both planes are in one cell, where a fragment in the middle takes a quarter of "
                "its "
                "own absorbance as being in front of it"},
               {{"leaves"},
                passes,
                "an absorbance of 10 in front leaves nothing of the farther plane, even from a part of a "
                "cell"},
               {{"opaque_front", "opaque_behind", "opaque_between"},
                passes,
                "both passes are tested against the opaque depth, and the layers at 0.3 and 0.7 lie in the middle of "
                "their cells, so that both lose the same part to themselves"},
               {{"one_layer"}, passes, "one layer is its own mean, whatever its weight"},
               {{"64_layers"},
                passes,
                "four layers per cell of nearly equal color, whose staircase is nearly a slope"}}}},
    };
}

}  // namespace sheer::test
