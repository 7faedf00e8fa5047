// Signed difference: how far off the method is, and in which direction, as in Table 6 of the front-to-back paper.
// Vlček, Havel, Herout: "Front-to-Back Blending with Early Fragment Discarding", SCCG 2010.

#include <array>
#include <cmath>

#include "renderer/metrics/shared/level_errors.h"
#include "renderer/metrics/shared/metric.h"

namespace sheer {
namespace {

/// Level of the picture for a difference of -255..255, at [difference + 255]. The square root makes a single level
/// visible (8 of 255) and still keeps the largest difference in range, so that pictures of different methods can be
/// compared.
std::array<std::uint8_t, 511> picture_levels() {
    std::array<std::uint8_t, 511> levels{};
    for (int difference = -255; difference <= 255; ++difference) {
        const int size = int(std::lround(127 * std::sqrt(std::abs(difference) / 255.0)));
        const int index = difference + 255;
        levels[std::size_t(index)] = std::uint8_t(128 + (difference < 0 ? -size : size));
    }
    return levels;
}

Image8 draw(const Image8& reference, const Image8& test) {
    const auto levels = picture_levels();
    Image8 picture(reference.width_px, reference.height_px);
    for (std::size_t i = 0; i < picture.rgb.size(); ++i) {
        const int index = reference.rgb[i] - test.rgb[i] + 255;
        picture.rgb[i] = levels[std::size_t(index)];
    }
    return picture;
}

MetricValue compute_signed(const ImagePair& pair) {
    const LevelErrors errors = level_errors(pair.reference8, pair.test8);
    return {{{"mean_abs", double(errors.sum_of_absolutes) / double(errors.count)},
             {"min", errors.min},
             {"max", errors.max}},
            draw(pair.reference8, pair.test8)};
}

}  // namespace

MetricInfo metric_signed() {
    return {
        .id = "signed",
        .name = "Signed difference",
        .summary =
            "Reference minus method in 8-bit levels over red, green and blue. In the picture mid grey (128) is no "
            "difference, brighter is where the reference is brighter; a difference of d levels is 127 sqrt(|d|/255) "
            "away from grey, so that one level is visible and 255 still fit.",
        .source = "Vlček, Havel, Herout, Front-to-Back Blending with Early Fragment Discarding, SCCG 2010, Table 6",
        .formula = "Σ|r − t| / n, min(r − t), max(r − t)",
        .good_for =
            "comparing with Table 6 of the paper; seeing whether a method is too bright (negative) or too dark "
            "(positive)",
        .picture = "difference",
        .place = 10,
        .fields = {{.name = "mean_abs",
                    .unit = "levels",
                    .range = "0..255",
                    .summary = "Mean of the absolute differences",
                    .column = {.head = "Mean |Δ|", .better = Better::lower, .terminal = {"mean |d|", 3}}},
                   {.name = "min",
                    .unit = "levels",
                    .range = "-255..255",
                    .summary = "Smallest difference: where the method is too bright",
                    .column = {.head = "Min Δ", .better = Better::nearer_zero, .terminal = {"min d", 0}}},
                   {.name = "max",
                    .unit = "levels",
                    .range = "-255..255",
                    .summary = "Greatest difference: where the method is too dark",
                    .column = {.head = "Max Δ", .better = Better::nearer_zero, .terminal = {"max d", 0}}}},
        .compute = compute_signed};
}

}  // namespace sheer
