#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <tuple>

#include "renderer/metrics/shared/metric.h"

namespace sheer {

std::vector<MetricInfo> make_metrics();

namespace {

void require_comparable(const Image& reference, const Image& test) {
    if (reference.width_px != test.width_px || reference.height_px != test.height_px)
        throw std::invalid_argument("pictures of different sizes cannot be compared");
    if (reference.width_px < 1 || reference.height_px < 1)
        throw std::invalid_argument("empty pictures cannot be compared");
    const std::size_t length = reference.pixel_count() * 4;
    if (reference.rgba.size() != length || test.rgba.size() != length)
        throw std::invalid_argument("a picture has more or fewer values than its size requires");
}

/// Whether any of `count` values is a NaN or an infinity: all bits of the exponent are set. In integers, since the
/// compiler vectorizes that.
bool any_non_finite(const float* values, std::size_t count) {
    std::uint32_t found = 0;
    for (std::size_t i = 0; i < count; ++i)
        found |= std::uint32_t((std::bit_cast<std::uint32_t>(values[i]) & 0x7f800000u) == 0x7f800000u);
    return found != 0;
}

/// A non-finite value may look right by chance (an infinity where the reference is white), so it becomes the level that
/// is furthest from the reference's.
void punish_non_finite(const Image& test, const Image8& reference8, Image8& test8) {
    for (int y = 0; y < test.height_px; ++y) {
        const float* row = test.pixel(0, y);
        if (!any_non_finite(row, std::size_t(test.width_px) * 4)) continue;
        for (int x = 0; x < test.width_px; ++x)
            for (int c = 0; c < 3; ++c)
                if (!std::isfinite(row[x * 4 + c])) test8.pixel(x, y)[c] = reference8.pixel(x, y)[c] < 128 ? 255 : 0;
    }
}

const Image& checked(const Image& reference, const Image& test) {
    require_comparable(reference, test);
    return reference;
}

std::vector<MetricInfo> in_order(std::vector<MetricInfo> metrics) {
    std::ranges::sort(metrics, {}, [](const MetricInfo& metric) { return std::tie(metric.place, metric.id); });
    return metrics;
}

}  // namespace

ImagePair::ImagePair(const Image& reference_image, const Image& test_image, const MorePictures& more_pictures)
    : reference(checked(reference_image, test_image)),
      test(test_image),
      reference8(quantize(more_pictures.reference_as_shown ? *more_pictures.reference_as_shown : reference_image)),
      test8(quantize(test_image)),
      more(more_pictures) {
    if (more.reference_as_shown) require_comparable(*more.reference_as_shown, test);
    for (const Backdrops* over : {more.reference_over, more.test_over}) {
        if (!over) continue;
        require_comparable(reference, over->black);
        require_comparable(reference, over->white);
    }
    punish_non_finite(test, reference8, test8);
}

std::string full_name(const MetricInfo& metric, const MetricField& field) {
    return field.name.empty() ? metric.id : metric.id + "." + field.name;
}

const std::vector<MetricInfo>& all_metrics() {
    static const std::vector<MetricInfo> metrics = in_order(make_metrics());
    return metrics;
}

Metrics compute_metrics(const Image& reference, const Image& test, const MorePictures& more) {
    const ImagePair pair(reference, test, more);
    Metrics result;
    result.values = nlohmann::json::object();
    for (const MetricInfo& metric : all_metrics()) {
        MetricValue value = metric.compute(pair);
        result.values[metric.id] = std::move(value.value);
        if (value.picture) result.pictures.emplace_back(metric.picture, std::move(*value.picture));
    }
    return result;
}

}  // namespace sheer
