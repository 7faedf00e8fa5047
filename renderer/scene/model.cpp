#include "renderer/scene/model.h"

#include <algorithm>
#include <cmath>

namespace sheer {

std::int32_t sampling_bits(const PictureUse& use) {
    return static_cast<int>(use.wrap_s) | static_cast<int>(use.wrap_t) << 2 | use.nearest_when_magnified << 4 |
           use.nearest_when_minified << 5 | static_cast<int>(use.mipmaps) << 6;
}

float srgb_encode(double linear) {
    const double x = std::clamp(linear, 0.0, 1.0);
    return static_cast<float>(x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055);
}

}  // namespace sheer
