// Root mean square error: the plain size of the difference; large errors count more.

#include <cmath>

#include "renderer/metrics/shared/level_errors.h"
#include "renderer/metrics/shared/metric.h"

namespace sheer {
namespace {

MetricValue compute_rmse(const ImagePair& pair) {
    return {std::sqrt(level_errors(pair.reference8, pair.test8).mean_square()), std::nullopt};
}

}  // namespace

MetricInfo metric_rmse() {
    return {.id = "rmse",
            .name = "RMSE",
            .summary = "Root mean square error over red, green and blue of the 8-bit pictures, as values in 0..1.",
            .source = "Textbook statistic: square root of the mean of squared differences",
            .formula = "√(Σ((r − t)/255)² / n)",
            .good_for = "one plain number; large errors count more",
            .place = 20,
            .fields = {{.range = "0..1",
                        .summary = "Root mean square error",
                        .column = {.head = "RMSE", .better = Better::lower}}},
            .compute = compute_rmse};
}

}  // namespace sheer
