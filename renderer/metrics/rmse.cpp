// Root mean square error: the plain size of the difference, large errors counting more.

#include <cmath>

#include "renderer/metrics/level_errors.h"
#include "renderer/metrics/metric.h"

namespace sheer {
namespace {

MetricValue compute_rmse(const ImagePair& pair) {
    return {std::sqrt(level_errors(pair.reference8, pair.test8).mean_square()), std::nullopt};
}

}  // namespace

MetricInfo metric_rmse() {
    return {"rmse",
            "RMSE",
            "Root mean square error over red, green and blue of the 8-bit pictures, as values in 0..1.",
            "Textbook statistic: square root of the mean of squared differences",
            "",
            {{"", "", "0..1", "Root mean square error"}},
            compute_rmse};
}

}  // namespace sheer
