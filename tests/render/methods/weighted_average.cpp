#include "renderer/litmus/formulas/weighted_average.h"

#include "tests/render/method_row.h"

#include <algorithm>
#include <cmath>

namespace sheer::test {

namespace {

/// In 16-bit floats a sum of n numbers is rounded n times, by 2^-10 of it at most. The quotient of two such sums is the
/// average color; the transmittance falls with the sum of the alphas by (1 - a / n)^(n - 1).
double average_bound(const Stack& stack, PixelFormat format) {
    const AverageSums sums = average_sums(stack);
    if (format == PixelFormat::rgba32f) return rounded_once(stack, format);
    const double off = (sums.count + 1) * 0x1p-10, alphas_off = sums.alphas * off + sums.count * 0x1p-24;
    const double average = sums.count == 0 ? 0 : std::max(0.0, 1 - (sums.alphas - alphas_off) / sums.count);
    const double rest_off = sums.count == 0 ? 0 : alphas_off * std::pow(std::min(average, 1.0), sums.count - 1);
    return std::min(1.0, 2 * off) + rest_off + step_of(format);
}

}  // namespace

MethodRow row_weighted_average() {
    return {
        .id = "weighted_average",
        .formula = formula_of("weighted_average"),
        .variants = {{nlohmann::json::object(), average_bound}},
        .litmus =
            {{"",
              {nlohmann::json::object()},
              {{{"shuffled"}, passes, "sums do not depend on the order, except for the rounding of each addition"},
               {{"overflow"}, passes, "the alphas sum to 31"},
               {{"self_overlap"},
                fails,
                "the mean color does not know what is in front, and the mean alpha of 0.6 lets another part of the "
                "background through"},
               {{"fade"},
                fails,
                "the inside of a model shows, as of any layers of that alpha: it does not know that they are one "
                "model"},
               {{"unequal", "window", "close_pair", "interleaved"},
                fails,
                "the mean color does not know what is in front, so of two leaves both show; where alphas differ, their "
                "mean lets another part of the background through"},
               {{"black", "white", "checker", "opaque_behind", "glass"},
                fails,
                "with equal alphas the transmittance is right, but near and far colors have the same weight: for "
                "two layers of 0.5 an eighth of their difference"},
               {{"alpha_to_0"},
                passes,
                "for faint layers order hardly matters: the weights differ by the square of alpha"},
               {{"alpha_to_1", "leaves"},
                fails,
                "it shows the mean of the layers, of which the nearest hides the others"},
               {{"opaque_front"}, passes, "the depth test hides what is behind"},
               {{"opaque_between", "one_layer"}, passes, "one layer is its own average"},
               {{"64_layers"},
                fails,
                "the mean of all colors is mostly blue and green; the nearest eight layers should have 0.4 of the "
                "weight and have an eighth"}}}},
    };
}

}  // namespace sheer::test
