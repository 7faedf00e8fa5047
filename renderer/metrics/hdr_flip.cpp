// HDR-FLIP: what a person sees when flipping between the two pictures at whatever exposure they are looked at.
// Andersson, Nilsson, Shirley, Akenine-Möller: "Visualizing Errors in Rendered High Dynamic Range Images", Eurographics
// 2021 short papers. The pictures are taken at several exposures, from the one at which the brightest pixel is just not
// white to the one at which the median is, tone-mapped with the ACES curve and compared by LDR-FLIP; the greatest value
// of each pixel counts.

#include <algorithm>
#include <cmath>

#include "renderer/metrics/shared/error_distribution.h"
#include "renderer/metrics/shared/flip_map.h"
#include "renderer/metrics/shared/float_errors.h"
#include "renderer/metrics/shared/metric.h"

namespace sheer {
namespace {

/// Narkowicz's fit of the ACES curve with an exposure of 0.6: (a x + b) x / ((c x + d) x + e).
constexpr double aces_a = 0.6 * 0.6 * 2.51, aces_b = 0.6 * 0.03, aces_c = 0.6 * 0.6 * 2.43, aces_d = 0.6 * 0.59,
                 aces_e = 0.14;
/// What the tone-mapped value of the brightest pixel and of the median is at the first and the last exposure.
constexpr double nearly_white = 0.85;

float tone_mapped(float linear) {
    const double x = linear;
    return float(std::clamp((aces_a * x + aces_b) * x / ((aces_c * x + aces_d) * x + aces_e), 0.0, 1.0));
}

/// The linear value that is tone-mapped to `nearly_white`.
double nearly_white_linear() {
    const double a = aces_a - nearly_white * aces_c, b = aces_b - nearly_white * aces_d, c = -nearly_white * aces_e;
    return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

/// The transfer function of sRGB, continued over 1.
float linear_of(float encoded) {
    if (encoded <= 0) return 0;
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

LinearPicture linear_picture(const Image& image) {
    LinearPicture picture{image.width_px, image.height_px, {}};
    picture.rgb.reserve(image.pixel_count() * 3);
    for (std::size_t i = 0; i < image.pixel_count(); ++i)
        for (std::size_t channel = 0; channel < 3; ++channel)
            picture.rgb.push_back(linear_of(image.rgba[4 * i + channel]));
    return picture;
}

bool exceeds_1(const Image& image) {
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
        if (i % 4 != 3 && image.rgba[i] > 1) return true;
    return false;
}

struct Exposures {
    double start = 0, stop = 0;  ///< as powers of 2
    int count = 2;
};

/// From the reference's luminances that are not 0; the median of an even number is the mean of the middle two.
Exposures exposures_of(const LinearPicture& reference) {
    std::vector<float> luminances;
    for (std::size_t i = 0; i < reference.rgb.size(); i += 3) {
        const float luminance =
            0.2126f * reference.rgb[i] + 0.7152f * reference.rgb[i + 1] + 0.0722f * reference.rgb[i + 2];
        if (luminance > 0) luminances.push_back(luminance);
    }
    if (luminances.empty()) return {};
    std::ranges::sort(luminances);
    const double median = (double{luminances[(luminances.size() - 1) / 2]} + luminances[luminances.size() / 2]) / 2;
    Exposures exposures{std::log2(nearly_white_linear() / luminances.back()), std::log2(nearly_white_linear() / median),
                        2};
    exposures.count = std::max(2, int(std::ceil(exposures.stop - exposures.start)));
    return exposures;
}

LinearPicture exposed(const LinearPicture& picture, double exposure) {
    const auto factor = float(std::exp2(exposure));
    LinearPicture result{picture.width_px, picture.height_px, {}};
    result.rgb.reserve(picture.rgb.size());
    for (const float value : picture.rgb) result.rgb.push_back(tone_mapped(factor * value));
    return result;
}

MetricValue none(const char* reason) {
    return {{{"mean", nullptr},
             {"weighted_median", nullptr},
             {"p99", nullptr},
             {"max", nullptr},
             {"exposures", nullptr},
             {"reason", reason}},
            std::nullopt};
}

MetricValue compute_hdr_flip(const ImagePair& pair) {
    if (!float_errors(pair.reference, pair.test).finite()) return none("a picture has a NaN or an infinity");
    if (!exceeds_1(pair.reference) && !exceeds_1(pair.test)) return none("no value is over 1: flip says it all");
    const LinearPicture reference = linear_picture(pair.reference), test = linear_picture(pair.test);
    const Exposures exposures = exposures_of(reference);
    std::vector<float> greatest(pair.reference.pixel_count());
    for (int i = 0; i < exposures.count; ++i) {
        const double exposure = exposures.start + i * (exposures.stop - exposures.start) / (exposures.count - 1);
        const std::vector<float> map = flip_map(exposed(reference, exposure), exposed(test, exposure));
        for (std::size_t k = 0; k < map.size(); ++k) greatest[k] = std::max(greatest[k], map[k]);
    }
    const ErrorDistribution distribution(greatest);
    return {{{"mean", distribution.mean()},
             {"weighted_median", distribution.weighted(0.5)},
             {"p99", distribution.percentile(99)},
             {"max", distribution.max()},
             {"exposures", exposures.count}},
            std::nullopt};
}

}  // namespace

MetricInfo metric_hdr_flip() {
    const auto over_pixels = [](std::string name, std::string summary) {
        return MetricField{.name = std::move(name), .range = "0..1", .summary = std::move(summary)};
    };
    return {
        .id = "hdr_flip",
        .name = "HDR-FLIP",
        .summary =
            "FLIP of float pictures with values over 1, at the exposure at which each pixel differs most. Null with a "
            "reason if no value is over 1, or if one is not finite.",
        .source =
            "Andersson et al., Visualizing Errors in Rendered High Dynamic Range Images, Eurographics 2021 (HDR-FLIP)",
        .formula = "the greatest LDR-FLIP of a pixel over the exposures of the paper, tone-mapped with the ACES curve",
        .good_for = "light that is brighter than white: emission, additive blending, sums that should have been means",
        .place = 52,
        .fields = {over_pixels("mean", "Mean over the pixels"),
                   over_pixels("weighted_median",
                               "Value up to which the pixels account for half of the sum of all values"),
                   over_pixels("p99", "99th percentile of the pixels, nearest rank"),
                   over_pixels("max", "Greatest value of any pixel"),
                   {.name = "exposures",
                    .kind = MetricField::Kind::count,
                    .range = "2..",
                    .summary = "Exposures that were looked at"}},
        .compute = compute_hdr_flip};
}

}  // namespace sheer
