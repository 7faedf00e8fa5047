// How many pixels are not exactly the reference's: zero proves that two methods agree.

#include "renderer/metrics/shared/metric.h"

namespace sheer {
namespace {

MetricValue compute_differing_pixels(const ImagePair& pair) {
    const std::uint8_t* one = pair.reference8.rgb.data();
    const std::uint8_t* two = pair.test8.rgb.data();
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < pair.reference8.pixel_count(); ++i, one += 3, two += 3)
        count += ((one[0] ^ two[0]) | (one[1] ^ two[1]) | (one[2] ^ two[2])) != 0;
    return {count, std::nullopt};
}

}  // namespace

MetricInfo metric_differing_pixels() {
    return {.id = "differing_pixels",
            .name = "Differing pixels",
            .summary = "Pixels whose red, green or blue differs from the reference's by at least one 8-bit level.",
            .source = "Count of unequal pixels",
            .formula = "pixels with r ≠ t in any channel",
            .good_for = "proving that two methods agree exactly",
            .place = 60,
            .fields = {{.kind = MetricField::Kind::count,
                        .unit = "px",
                        .range = "0..width*height",
                        .summary = "Number of pixels that differ",
                        .column = {.head = "Differing", .better = Better::lower, .terminal = {"differing px", 0}}}},
            .compute = compute_differing_pixels};
}

}  // namespace sheer
