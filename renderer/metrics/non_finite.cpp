// Pixels that are not valid colors: they appear if a method divides by a zero alpha or overflows its target.

#include <bit>

#include "renderer/metrics/shared/metric.h"

namespace sheer {
namespace {

/// 1 for a NaN or an infinity: all bits of the exponent are set.
std::uint32_t non_finite(float value) {
    return (std::bit_cast<std::uint32_t>(value) & 0x7f800000u) == 0x7f800000u;
}

MetricValue compute_non_finite(const ImagePair& pair) {
    const float* rgba = pair.test.rgba.data();
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < pair.test.pixel_count(); ++i, rgba += 4)
        count += non_finite(rgba[0]) | non_finite(rgba[1]) | non_finite(rgba[2]) | non_finite(rgba[3]);
    return {count, std::nullopt};
}

}  // namespace

MetricInfo metric_non_finite() {
    return {.id = "non_finite",
            .name = "Non-finite pixels",
            .summary =
                "Pixels of the method's float picture with a NaN or an infinity in red, green, blue or alpha. The "
                "other metrics count such a channel as the level furthest from the reference.",
            .source = "IEEE 754 classification",
            .formula = "pixels with a NaN or an infinity in red, green, blue or alpha of the float picture",
            .good_for = "divisions by zero, overflow of a half-float target",
            .place = 70,
            .fields = {{.kind = MetricField::Kind::count,
                        .unit = "px",
                        .range = "0..width*height",
                        .summary = "Number of pixels with a NaN or an infinity",
                        .column = {.head = "Non-finite", .better = Better::lower}}},
            .compute = compute_non_finite};
}

}  // namespace sheer
