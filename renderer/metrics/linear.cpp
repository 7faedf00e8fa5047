// Errors of the float picture: what rounding to 8 bits hides, such as a difference below a level or values over 1.

#include "renderer/metrics/shared/float_errors.h"
#include "renderer/metrics/shared/metric.h"

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
        .id = "linear",
        .name = "Float picture",
        .summary =
            "Differences over red, green and blue of the float pictures, neither clamped nor rounded, in the values "
            "that were blended. In the format rgba8 the method's values are multiples of 1/255. Null with a reason "
            "if a value is not finite.",
        .source = "Textbook statistics: mean and greatest absolute difference, root of the mean square",
        .formula = "mean and greatest |r − t| and √(Σ(r − t)² / n) of the float values",
        .good_for = "errors smaller than a level or above white, which rounding and clamping hide",
        .place = 55,
        .fields = {{.name = "mean_abs", .range = "0..", .summary = "Mean absolute difference"},
                   {.name = "rmse",
                    .range = "0..",
                    .summary = "Root mean square error",
                    .column = {.head = "Float RMSE", .better = Better::lower}},
                   {.name = "max_abs", .range = "0..", .summary = "Greatest absolute difference of a channel"}},
        .compute = compute_linear};
}

}  // namespace sheer
