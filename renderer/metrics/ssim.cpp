// SSIM: how similar the structure of the two pictures is, window by window. The windows are in
// renderer/metrics/shared/ssim_map.cpp; no border is invented.

#include "renderer/metrics/shared/ssim_map.h"

#include <numeric>

namespace sheer {
namespace {

MetricValue compute_ssim(const ImagePair& pair) {
    const SsimMap map = ssim_map(pair);
    return {std::accumulate(map.values.begin(), map.values.end(), 0.0) / double(map.values.size()), std::nullopt};
}

}  // namespace

MetricInfo metric_ssim() {
    return {
        .id = "ssim",
        .name = "SSIM",
        .summary =
            "Structural similarity, mean over red, green and blue and over the 11x11 Gaussian windows that are wholly "
            "inside the picture; 1 if the pictures are identical.",
        .source =
            "Wang et al., Image Quality Assessment: From Error Visibility to Structural Similarity, IEEE TIP 2004",
        .formula = "mean of Wang's SSIM, equation 13",
        .good_for = "structure: blurred or lost texture that leaves the mean color alone",
        .place = 40,
        .fields = {{.range = "-1..1",
                    .summary = "Mean structural similarity",
                    .column = {.head = "SSIM", .better = Better::higher, .digits = 4, .terminal = {"SSIM", 4}}}},
        .compute = compute_ssim};
}

}  // namespace sheer
