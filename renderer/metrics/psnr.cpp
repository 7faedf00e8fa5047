// Peak signal-to-noise ratio: the mean square error on a logarithmic scale. The peak is the format's, 1, never the
// picture's own maximum, so that dark pictures are not judged more harshly.

#include <cmath>

#include "renderer/metrics/shared/level_errors.h"
#include "renderer/metrics/shared/metric.h"

namespace sheer {
namespace {

MetricValue compute_psnr(const ImagePair& pair) {
    const double mean_square = level_errors(pair.reference8, pair.test8).mean_square();
    if (mean_square == 0) return {nullptr, std::nullopt};
    return {-10 * std::log10(mean_square), std::nullopt};
}

}  // namespace

MetricInfo metric_psnr() {
    return {.id = "psnr",
            .name = "PSNR",
            .summary =
                "Peak signal-to-noise ratio over red, green and blue of the 8-bit pictures with peak 1; null if the "
                "pictures are identical.",
            .source =
                "Huynh-Thu and Ghanbari, Scope of Validity of PSNR in Image/Video Quality Assessment, Electronics "
                "Letters 2008",
            .formula = "−20 log₁₀(rmse): the peak is 1, the format's, not the picture's",
            .good_for = "the same on a scale on which errors at 40 dB and more are hard to see",
            .place = 30,
            .fields = {{.unit = "dB",
                        .range = "0..",
                        .summary = "Peak signal-to-noise ratio; null if the pictures are identical",
                        .null_is_identical = true,
                        .column = {.head = "PSNR", .better = Better::higher, .terminal = {"PSNR dB", 1}}}},
            .compute = compute_psnr};
}

}  // namespace sheer
