// How many pixels are not exactly the reference's: zero is the proof that two methods agree.

#include "renderer/metrics/metric.h"

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
    return {"differing_pixels",
            "Differing pixels",
            "Pixels whose red, green or blue differs from the reference's by at least one 8-bit level.",
            "Count of unequal pixels",
            "",
            {{"", "pixels", "0..width*height", "Number of pixels that differ"}},
            compute_differing_pixels};
}

}  // namespace sheer
