// The worst part of the picture by SSIM, whose mean over all of it may hide a small part that is quite wrong.

#include "renderer/metrics/shared/ssim_map.h"
#include "renderer/metrics/shared/worst_tile.h"

namespace sheer {
namespace {

MetricValue compute_ssim_tile(const ImagePair& pair) {
    const SsimMap map = ssim_map(pair);
    const WorstTile worst = least_tile(map.values, map.width_px, map.height_px);
    return {{{"worst", worst.mean}, {"at", {map.left + worst.x, map.top + worst.y}}}, std::nullopt};
}

}  // namespace

MetricInfo metric_ssim_tile() {
    return {.id = "ssim_tile",
            .name = "SSIM of the worst tile",
            .summary = "The least mean of SSIM over a tile of 64x64 windows, and where it is.",
            .source =
                "Wang et al., Image Quality Assessment: From Error Visibility to Structural Similarity, IEEE TIP 2004",
            .formula = "the least mean of Wang's SSIM over 64x64 windows",
            .good_for = "how bad the worst part is: a mean over a picture that is mostly background hides it",
            .place = 45,
            .fields = {{.name = "worst", .range = "-1..1", .summary = "Least mean structural similarity of a tile"},
                       {.name = "at",
                        .kind = MetricField::Kind::pixel,
                        .unit = "px",
                        .range = "[0..width-1, 0..height-1]",
                        .summary = "The middle of the tile's first window"}},
            .compute = compute_ssim_tile};
}

}  // namespace sheer
