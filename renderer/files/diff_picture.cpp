#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "renderer/files/diff_parts.h"
#include "renderer/files/picture_file.h"
#include "renderer/metrics/metric.h"

namespace sheer {

using nlohmann::json;

namespace {

Image as_floats(const Image8& picture) {
    Image image(picture.width_px, picture.height_px);
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) image.rgba[i * 4 + c] = static_cast<float>(picture.rgb[i * 3 + c]) / 255;
        image.rgba[i * 4 + 3] = 1;
    }
    return image;
}

Image read(const DiffSide& side, const json& image, int width_px, int height_px) {
    const std::string bytes = side.read_picture(image);
    if (sha256_hex(bytes) != image.at("sha256").get<std::string>())
        throw std::runtime_error("a picture is not the one that its report names");
    return as_floats(decode_png(bytes, width_px, height_px));
}

MetricValue measure(const std::string& id, const ImagePair& pair) {
    return std::ranges::find(all_metrics(), id, &MetricInfo::id)->compute(pair);
}

const json* picture(const json& images, const char* name) {
    const auto found = images.find(name);
    return found == images.end() || !found->is_object() ? nullptr : &*found;
}

/// Whether the floats are the same where both reports keep them; null otherwise.
json linear_verdict(const json& a, const json& b) {
    const json *of_a = picture(a, "linear"), *of_b = picture(b, "linear");
    if (!of_a || !of_b) return nullptr;
    return of_a->at("sha256") == of_b->at("sha256") ? "identical" : "different";
}

}  // namespace

json PictureDiff::compare(const json& a, const json& b, int width_px, int height_px, const std::string& name) {
    const json *of_a = picture(a, "color"), *of_b = picture(b, "color");
    if (!of_a || !of_b) return nullptr;
    json result;
    const auto pixels = static_cast<std::uint64_t>(width_px) * static_cast<std::uint64_t>(height_px);
    if (of_a->at("sha256") == of_b->at("sha256")) {
        result = {{"verdict", "identical"},
                  {"flip", {{"mean", 0.0}, {"max", 0.0}}},
                  {"differing_pixels", 0},
                  {"greatest_levels", 0},
                  {"worst_pixel", nullptr}};
    } else if (pixels > m_pixels_left) {
        result = {{"verdict", "not examined"}, {"reason", "the pictures of this diff are too large together"}};
    } else {
        m_pixels_left -= pixels;
        result = examine(*of_a, *of_b, width_px, height_px, name);
    }
    result["linear"] = linear_verdict(a, b);
    result["a"] = *of_a;
    result["b"] = *of_b;
    return result;
}

json PictureDiff::examine(const json& a, const json& b, int width_px, int height_px, const std::string& name) {
    const Image of_a = read(m_a, a, width_px, height_px), of_b = read(m_b, b, width_px, height_px);
    const ImagePair pair(of_a, of_b);
    const MetricValue flip = measure("flip", pair);
    const json levels = measure("signed", pair).value, differing = measure("differing_pixels", pair).value;
    json result = {
        {"verdict", differing == 0 ? "identical" : "different"},
        {"flip", {{"mean", flip.value["mean"]}, {"max", flip.value["max"]}}},
        {"differing_pixels", differing},
        {"greatest_levels", std::max(std::abs(levels["min"].get<int>()), std::abs(levels["max"].get<int>()))},
        {"worst_pixel", measure("worst_pixel", pair).value}};
    if (m_sink && differing != 0) {
        const std::string png = encode_png(flip.picture.value()), sha256 = sha256_hex(png);
        result["flip_picture"] = {{"sha256", sha256},
                                  {"url", m_sink->put(sha256, png, name + ".flip.png", "image/png")},
                                  {"media_type", "image/png"}};
    }
    return result;
}

}  // namespace sheer
