// Where to look first: the pixel that is furthest from the reference.

#include <cstdlib>

#include "renderer/metrics/metric.h"

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
        "worst_pixel",
        "Worst pixel",
        "[x, y] of the pixel with the greatest sum of absolute differences of its 8-bit red, green and blue, the first "
        "in row order where several share it; origin top left; null where the pictures are identical.",
        "Greatest L1 distance per pixel",
        "",
        {{"", "px", "[0..width-1, 0..height-1]", "Position of the worst pixel; null where identical", false}},
        compute_worst_pixel};
}

}  // namespace sheer
