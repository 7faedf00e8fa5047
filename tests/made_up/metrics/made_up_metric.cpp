// How red the method's picture is.
#include "renderer/metrics/shared/metric.h"

namespace sheer {
namespace {

MetricValue compute_made_up_metric(const ImagePair& pair) {
    double sum = 0;
    for (std::size_t i = 0; i < pair.test8.rgb.size(); i += 3) sum += pair.test8.rgb[i];
    return {sum / double(pair.test8.pixel_count()), std::nullopt};
}

}  // namespace

MetricInfo metric_made_up_metric() {
    return {.id = "made_up_metric",
            .name = "Made-up metric",
            .summary = "Mean red level of the method's picture.",
            .source = "Made up",
            .formula = "Σ red / pixels",
            .good_for = "finding a new metric wherever metrics are",
            .place = 15,
            .fields = {{.unit = "reds",
                        .range = "0..255",
                        .summary = "Mean level of red",
                        .column = {.head = "Redness", .better = Better::higher, .terminal = {"redness", 1}}}},
            .compute = compute_made_up_metric};
}

}  // namespace sheer
