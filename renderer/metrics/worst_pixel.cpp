// Where to look first: the pixel that is furthest from the reference.

#include <cstdlib>

#include "renderer/metrics/shared/metric.h"

namespace sheer {
namespace {

MetricValue compute_worst_pixel(const ImagePair& pair) {
    const std::uint8_t* one = pair.reference8.rgb.data();
    const std::uint8_t* two = pair.test8.rgb.data();
    int worst = 0;
    std::size_t index = 0;
    for (std::size_t i = 0; i < pair.reference8.pixel_count(); ++i, one += 3, two += 3) {
        const int sum = std::abs(one[0] - two[0]) + std::abs(one[1] - two[1]) + std::abs(one[2] - two[2]);
        if (sum <= worst) continue;
        worst = sum;
        index = i;
    }
    if (worst == 0) return {nullptr, std::nullopt};
    const std::size_t width = std::size_t(pair.reference8.width_px);
    return {nlohmann::json::array({index % width, index / width}), std::nullopt};
}

}  // namespace

MetricInfo metric_worst_pixel() {
    return {
        .id = "worst_pixel",
        .name = "Worst pixel",
        .summary =
            "[x, y] of the pixel with the greatest sum of absolute differences of its 8-bit red, green and blue, the "
            "first in row order if there are several; origin top left; null if the pictures are identical.",
        .source = "Greatest L1 distance per pixel",
        .formula = "[x, y] of the greatest Σ|r − t| of a pixel, the first in row order",
        .good_for = "where to look, or to ask for the fragments",
        .place = 65,
        .fields = {{.kind = MetricField::Kind::pixel,
                    .unit = "px",
                    .range = "[0..width-1, 0..height-1]",
                    .summary = "Position of the worst pixel; null if the pictures are identical",
                    .null_is_identical = true,
                    .column = {.head = "Worst pixel"}}},
        .compute = compute_worst_pixel};
}

}  // namespace sheer
