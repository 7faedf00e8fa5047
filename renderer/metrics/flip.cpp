// FLIP: what a person sees when flipping between the two pictures on a screen.
// Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild: "FLIP: A Difference Evaluator for Alternating
// Images", HPG 2020. The map is in renderer/metrics/shared/flip_map.cpp; here it is pooled and colored.

#include "renderer/metrics/shared/flip_map.h"

#include <algorithm>

#include "renderer/image/magma.h"
#include "renderer/metrics/shared/error_distribution.h"
#include "renderer/metrics/shared/metric.h"
#include "renderer/metrics/shared/worst_tile.h"

namespace sheer {
namespace {

Image8 colored(const std::vector<float>& map, int width, int height) {
    Image8 picture(width, height);
    for (std::size_t i = 0; i < map.size(); ++i) {
        const auto& color = magma()[std::size_t(map[i] * 255 + 0.5f)];
        std::copy(color.begin(), color.end(), &picture.rgb[i * 3]);
    }
    return picture;
}

MetricValue compute_flip(const ImagePair& pair) {
    const std::vector<float> map = flip_map(pair.reference8, pair.test8);
    const ErrorDistribution distribution(map);
    const WorstTile worst = greatest_tile(map, pair.reference8.width_px, pair.reference8.height_px);
    return {{{"mean", distribution.mean()},
             {"weighted_median", distribution.weighted(0.5)},
             {"weighted_q1", distribution.weighted(0.25)},
             {"weighted_q3", distribution.weighted(0.75)},
             {"max", distribution.max()},
             {"p95", distribution.percentile(95)},
             {"p99", distribution.percentile(99)},
             {"worst_tile", worst.mean},
             {"worst_tile_at", {worst.x, worst.y}}},
            colored(map, pair.reference8.width_px, pair.reference8.height_px)};
}

}  // namespace

MetricInfo metric_flip() {
    const auto over_pixels = [](std::string name, std::string summary, MetricColumn column = {}) {
        return MetricField{
            .name = std::move(name), .range = "0..1", .summary = std::move(summary), .column = std::move(column)};
    };
    return {
        .id = "flip",
        .name = "FLIP",
        .summary =
            "Visible difference when flipping between the pictures on a screen with 67 pixels per degree: 0 is none, "
            "1 the greatest possible. The picture shows it per pixel in magma colors, black to pale yellow for 0 to "
            "1.",
        .source = "Andersson et al., FLIP: A Difference Evaluator for Alternating Images, HPG 2020 (LDR-FLIP)",
        .formula = "LDR-FLIP of the paper at 67 pixels per degree",
        .good_for = "what a person notices when switching between the pictures; the best single measure for a preview",
        .picture = "flip",
        .place = 50,
        .fields = {over_pixels("mean", "Mean over the pixels",
                               {.head = "FLIP mean", .better = Better::lower, .terminal = {"FLIP", 4}}),
                   over_pixels("weighted_median",
                               "Value up to which the pixels account for half of the sum of all FLIP values"),
                   over_pixels("weighted_q1",
                               "Value up to which the pixels account for a quarter of the sum of all FLIP values"),
                   over_pixels("weighted_q3",
                               "Value up to which the pixels account for three quarters of the sum of all FLIP values"),
                   over_pixels("max", "Greatest value of any pixel"),
                   over_pixels("p95", "95th percentile of the pixels, nearest rank"),
                   over_pixels("p99", "99th percentile of the pixels, nearest rank"),
                   over_pixels("worst_tile",
                               "Greatest mean of a tile of 64x64 pixels: how bad the worst part is, however small"),
                   {.name = "worst_tile_at",
                    .kind = MetricField::Kind::pixel,
                    .unit = "px",
                    .range = "[0..width-1, 0..height-1]",
                    .summary = "Top left pixel of that tile"}},
        .compute = compute_flip};
}

}  // namespace sheer
