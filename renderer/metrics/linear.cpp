// Errors of the float picture: what rounding to 8 bits hides, such as a difference below a level or values over 1.

#include "renderer/metrics/float_errors.h"
#include "renderer/metrics/metric.h"

namespace sheer {
namespace {

MetricValue compute_linear(const ImagePair& pair) {
    const FloatErrors errors = float_errors(pair.reference, pair.test);
    if (!errors.finite())
        return {{{"mean_abs", nullptr},
                 {"rmse", nullptr},
                 {"max_abs", nullptr},
                 {"reason", "a picture has a NaN or an infinity"}},
                std::nullopt};
    return {{{"mean_abs", errors.mean_abs()}, {"rmse", errors.rmse()}, {"max_abs", errors.greatest}}, std::nullopt};
}

}  // namespace

MetricInfo metric_linear() {
    return {
        "linear",
        "Float picture",
        "Differences over red, green and blue of the float pictures, neither clamped nor rounded, in the values that "
        "were blended. In the format rgba8 the method's values are multiples of 1/255. Null with a reason where a "
        "value is not finite.",
        "Textbook statistics: mean and greatest absolute difference, root of the mean square",
        "",
        {{"mean_abs", "", "0..", "Mean absolute difference"},
         {"rmse", "", "0..", "Root mean square error"},
         {"max_abs", "", "0..", "Greatest absolute difference of a channel"}},
        compute_linear};
}

}  // namespace sheer
