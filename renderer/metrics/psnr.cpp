// Peak signal-to-noise ratio: the mean square error on a logarithmic scale. The peak is the format's, 1, never the
// picture's own maximum, so that dark pictures are not judged more harshly.

#include <cmath>

#include "renderer/metrics/level_errors.h"
#include "renderer/metrics/metric.h"

namespace sheer {
namespace {

MetricValue compute_psnr(const ImagePair& pair) {
    const double mean_square = level_errors(pair.reference8, pair.test8).mean_square();
    if (mean_square == 0) return {nullptr, std::nullopt};
    return {-10 * std::log10(mean_square), std::nullopt};
}

}  // namespace

MetricInfo metric_psnr() {
    return {
        "psnr",
        "PSNR",
        "Peak signal-to-noise ratio over red, green and blue of the 8-bit pictures with peak 1; null where the "
        "pictures are identical.",
        "Huynh-Thu and Ghanbari, Scope of Validity of PSNR in Image/Video Quality Assessment, Electronics Letters 2008",
        "",
        {{"", "dB", "0..", "Peak signal-to-noise ratio; null where identical"}},
        compute_psnr};
}

}  // namespace sheer
