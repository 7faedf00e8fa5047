#include "renderer/litmus/formulas/mboit.h"

#include "tests/render/method_row.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <map>
#include <memory>

namespace sheer::test {

namespace {

/// How much the result changes if each moment is off by as much as its sum may be, up or down: in 32-bit floats by
/// 2^-22 of the absorbance; in half floats, to which a driver may round by cutting off, by a step for each fragment.
/// That is far more than a rounding where the moments are those of few layers, since then the matrix is nearly
/// singular. With 8 moments in half floats it is so often that the change is not proportional; mboit_test bounds that.
double change_by_rounding(const Stack& stack, const MomentParameters& of) {
    const Numbers sums = moment_sums(stack, of);
    if (sums[0] == Complex(0)) return 0;
    const Color exact = blended_by_moments(stack, sums, of);
    const Real off_by = of.is_half ? 0x1p-10L * static_cast<Real>(stack.fragments.size()) : 0x1p-22L;
    double sum = 0;
    for (std::size_t k = 1; k < sums.size(); ++k)
        for (const Complex& direction : {Complex(1), Complex(0, 1)}) {
            if (of.is_power && direction.imag() != 0) continue;
            Numbers off = sums;
            off[k] += direction * sums[0] * off_by;
            const Color color = blended_by_moments(stack, off, of);
            double change = 0;
            for (std::size_t i = 0; i < 3; ++i) change = std::max(change, std::abs(color[i] - exact[i]));
            sum += std::isfinite(change) ? 2 * change : 1;
        }
    return sum;
}

Bound moments_bound(const nlohmann::json& parameters) {
    const auto change = remembered<double>(
        [of = moment_parameters(parameters)](const Stack& stack) { return change_by_rounding(stack, of); });
    return [=](const Stack& stack, PixelFormat format) {
        return std::min(1.0, 1e-5 + change(stack) + (format == PixelFormat::rgba32f ? 0 : 1.01 * step_of(format)));
    };
}

MethodVariant moments_variant(const nlohmann::json& parameters) {
    return {parameters, moments_bound(parameters), false, 64};
}

}  // namespace

MethodRow row_mboit() {
    return {
        .id = "mboit",
        .formula = formula_of("mboit"),
        .weighs_depths = true,
        .variants = {moments_variant(nlohmann::json::object()), moments_variant({{"overestimation", 0}}),
                     moments_variant({{"moments", 6}}), moments_variant({{"moments", 8}}),
                     moments_variant({{"kind", "trigonometric"}}),
                     moments_variant({{"kind", "trigonometric"}, {"moments", 6}}),
                     moments_variant({{"kind", "trigonometric"}, {"moments", 8}}),
                     moments_variant({{"precision", "float16"}}),
                     moments_variant({{"precision", "float16"}, {"kind", "trigonometric"}}),
                     moments_variant({{"bias_scale", 100}, {"greatest_absorbance", 3}})},
        .litmus =
            {{"",
              {nlohmann::json::object()},
              {{{"shuffled"}, passes, "moments are sums, which do not depend on the order, except for rounding"},
               {{"overflow"}, passes, "absorbances and moments are summed in 32-bit floats"},
               {{"self_overlap"},
                fails,
                "a quarter of its own absorbance is taken to be in front of each layer, which makes 0.8 fainter than "
                "0.4: by 12 levels"},
               {{"fade"},
                fails,
                "the inside of a model shows, as of any layers of that alpha: it does not know that they are one "
                "model"},
               {{"unequal"},
                fails,
                "a quarter of its own absorbance is taken to be in front of each layer, which makes a layer the "
                "fainter the higher its alpha is"},
               {{"window"},
                fails,
                "a quarter of an absorbance of 10 hides the leaf from itself, and the glass in front gets its weight"},
               {{"close_pair"},
                passes,
                "four moments suffice for three layers, however close, and with equal alphas each loses the same part "
                "to the overestimation"},
               {{"interleaved"}, fails, "four moments do not tell sixteen layers apart; the nearest shows too little"},
               {{"black", "white", "checker", "glass", "opaque_behind"},
                passes,
                "four moments suffice for three layers, and with equal alphas each loses the same part to the "
                "overestimation"},
               {{"alpha_to_0"}, passes, "faint layers hardly hide each other"},
               {{"alpha_to_1", "leaves"},
                passes,
                "an absorbance of 5 and more in front leaves nothing of the farther layers"},
               {{"opaque_front", "opaque_between"}, passes, "both passes are tested against the opaque depth"},
               {{"one_layer"}, passes, "one layer is its own mean, whatever its weight"},
               {{"64_layers"}, fails, "four moments do not show where red ends and blue begins"}}}},
        .litmus_tolerance = 2e-3,
    };
}

}  // namespace sheer::test
