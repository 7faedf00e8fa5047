#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "renderer/core/sha256.h"
#include "renderer/diff/diff_parts.h"
#include "renderer/files/report_document.h"
#include "renderer/metrics/shared/metric.h"
#include "renderer/pictures/picture_file.h"

namespace sheer {

namespace {

Image as_floats(const Image8& picture) {
    Image image(picture.width_px, picture.height_px);
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) image.rgba[i * 4 + c] = static_cast<float>(picture.rgb[i * 3 + c]) / 255;
        image.rgba[i * 4 + 3] = 1;
    }
    return image;
}

Image read(const DiffSide& side, const report::Picture& picture, diff::Size size_px) {
    const std::string bytes = side.read_picture(picture);
    if (sha256_hex(bytes) != picture.sha256) throw std::runtime_error("a picture is not the one that its report names");
    return as_floats(decode_png(bytes, size_px.width, size_px.height));
}

MetricValue measure(const std::string& id, const ImagePair& pair) {
    return std::ranges::find(all_metrics(), id, &MetricInfo::id)->compute(pair);
}

/// Whether the floats are the same, if both reports keep them; none otherwise.
std::optional<diff::Floats> compare_floats(const report::Pictures& a, const report::Pictures& b) {
    const report::Picture *of_a = find_picture(a, "linear"), *of_b = find_picture(b, "linear");
    if (!of_a || !of_b) return std::nullopt;
    return of_a->sha256 == of_b->sha256 ? diff::Floats::identical : diff::Floats::different;
}

}  // namespace

std::optional<diff::PictureDiff> PictureComparison::compare(const report::Pictures& a, const report::Pictures& b,
                                                            diff::Size size_px, const std::string& name) {
    const report::Picture *of_a = find_picture(a, "color"), *of_b = find_picture(b, "color");
    if (!of_a || !of_b) return std::nullopt;
    diff::PictureDiff result;
    result.a = *of_a;
    result.b = *of_b;
    result.linear = compare_floats(a, b);
    const auto pixels = static_cast<std::uint64_t>(size_px.width) * static_cast<std::uint64_t>(size_px.height);
    if (of_a->sha256 == of_b->sha256) {
        result.verdict = diff::PictureVerdict::identical;
        result.flip = diff::FlipError{};
        result.differing_pixels = 0;
        result.greatest_levels = 0;
        result.worst_pixel.is_known = true;
    } else if (pixels > m_pixels_left) {
        result.reason = "the pictures of this diff are too large in total";
    } else {
        m_pixels_left -= pixels;
        examine(result, size_px, name);
    }
    return result;
}

void PictureComparison::examine(diff::PictureDiff& result, diff::Size size_px, const std::string& name) {
    const Image of_a = read(m_a, result.a, size_px), of_b = read(m_b, result.b, size_px);
    const ImagePair pair(of_a, of_b);
    const MetricValue flip = measure("flip", pair);
    const nlohmann::json levels = measure("signed", pair).value, worst = measure("worst_pixel", pair).value;
    const auto differing = measure("differing_pixels", pair).value.get<std::uint64_t>();
    result.verdict = differing == 0 ? diff::PictureVerdict::identical : diff::PictureVerdict::different;
    result.flip = diff::FlipError{flip.value["mean"], flip.value["max"]};
    result.differing_pixels = differing;
    result.greatest_levels = std::max(std::abs(levels["min"].get<int>()), std::abs(levels["max"].get<int>()));
    result.worst_pixel = {true, from_document<std::optional<std::array<int, 2>>>(worst)};
    if (m_sink && differing != 0) {
        const std::string png = encode_png(flip.picture.value()), sha256 = sha256_hex(png);
        report::Picture& map = result.flip_picture.emplace();
        map.sha256 = sha256;
        map.media_type = "image/png";
        map.url = m_sink->put(sha256, png, name + ".flip.png", map.media_type);
    }
}

}  // namespace sheer
