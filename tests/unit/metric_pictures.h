#pragma once
#include <array>
#include <cmath>

#include "renderer/metrics/shared/metric.h"

namespace sheer::test {

using Levels = std::array<int, 3>;

/// A float picture whose 8-bit levels are `level(x, y)`.
template <typename Function>
Image picture(int width, int height, const Function& level) {
    Image image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Levels levels = level(x, y);
            for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = float(levels[c]) / 255.0f;
            image.pixel(x, y)[3] = 1;
        }
    return image;
}

inline Image constant(int width, int height, Levels levels) {
    return picture(width, height, [&](int, int) { return levels; });
}

inline Image8 constant8(int width, int height, Levels levels) {
    return quantize(constant(width, height, levels));
}

inline nlohmann::json values(const Image& reference, const Image& test) {
    return compute_metrics(reference, test).values;
}

/// Two detailed pictures in closed form, which other programs can make too.
inline Levels busy(int x, int y) {
    Levels levels;
    for (int c = 0; c < 3; ++c) levels[c] = (x * 7 + y * 13 + (x * y) % 17 * 5 + c * 40) % 256;
    return levels;
}

inline Levels busy_distorted(int x, int y) {
    Levels levels = busy(x, y);
    for (int c = 0; c < 3; ++c) levels[c] = (levels[c] + (x * 5 + y * 3 + c) % 11 * 4) % 256;
    return levels;
}

/// The picture of a pair under `key`.
inline Image8 picture_of(const Metrics& metrics, const std::string& key) {
    for (const auto& [name, image] : metrics.pictures)
        if (name == key) return image;
    return {};
}

}  // namespace sheer::test
