#include "renderer/image/image.h"

#include <algorithm>
#include <array>

namespace sheer {

Image8 quantize(const Image& image) {
    Image8 result(image.width_px, image.height_px);
    // All channels are quantized first: a loop without gaps is vectorized.
    constexpr std::size_t at_once = 256;
    std::array<std::uint8_t, at_once * 4> levels;
    for (std::size_t first = 0; first < image.pixel_count(); first += at_once) {
        const std::size_t count = std::min(at_once, image.pixel_count() - first);
        const float* from = &image.rgba[first * 4];
        for (std::size_t i = 0; i < count * 4; ++i) {
            const float over_zero = from[i] > 0.0f ? from[i] : 0.0f;  // NaN compares false
            levels[i] = std::uint8_t(int((over_zero < 1.0f ? over_zero : 1.0f) * 255.0f + 0.5f));
        }
        std::uint8_t* to = &result.rgb[first * 3];
        for (std::size_t i = 0; i < count; ++i)
            for (int c = 0; c < 3; ++c) to[i * 3 + c] = levels[i * 4 + c];
    }
    return result;
}

}  // namespace sheer
