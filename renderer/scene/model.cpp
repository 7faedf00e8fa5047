#include "renderer/scene/model.h"

#include <algorithm>
#include <cmath>

namespace sheer {

float srgb_encode(double linear) {
    const double x = std::clamp(linear, 0.0, 1.0);
    return static_cast<float>(x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055);
}

}  // namespace sheer
