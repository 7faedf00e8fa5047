#include "tests/render/method_row.h"

#include <algorithm>
#include <cmath>

namespace sheer::test {

namespace {

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
        .formula = formula_of("wavelet"),
        .weighs_depths = true,
        .variants = {{nlohmann::json::object(), staircase_bound},
                     {{{"rank", 1}}, staircase_bound},
                     {{{"rank", 4}}, staircase_bound},
                     {{{"rank", 2}, {"greatest_absorbance", 2}}, staircase_bound}},
        .litmus =
            {{"",
              {nlohmann::json::object()},
              {{{"shuffled"}, passes, "coefficients are sums, which do not depend on the order, except for rounding"},
               {{"overflow"}, passes, "the coefficients are summed in 32-bit floats"},
               {{"self_overlap"},
                fails,
                "the part at 0.45 lies in the middle of a cell and takes a part of its own absorbance as being in "
                "front of it"},
               {{"fade"},
                fails,
                "the inside of a model shows, as of any layers of that alpha: it does not know that they are one "
                "model"},
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
