#include "renderer/scene/alpha_coverage.h"

#include <algorithm>
#include <cmath>

namespace sheer {

namespace {

/// Alphas of a repeating texture.
struct AlphaPlane {
    int width_px, height_px;
    std::vector<float> alphas;

    float at(int x, int y) const {
        const int column = (x % width_px + width_px) % width_px, row = (y % height_px + height_px) % height_px;
        return alphas[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_px) +
                      static_cast<std::size_t>(column)];
    }

    /// Filtered bilinearly; texel (0, 0) has its middle at (0, 0).
    float between(float x, float y) const {
        const float left = std::floor(x), top = std::floor(y), u = x - left, v = y - top;
        const int column = static_cast<int>(left), row = static_cast<int>(top);
        return (at(column, row) * (1 - u) + at(column + 1, row) * u) * (1 - v) +
               (at(column, row + 1) * (1 - u) + at(column + 1, row + 1) * u) * v;
    }

    /// What a magnified texture shows: several samples to a texel if there are few texels.
    std::vector<float> samples() const {
        constexpr int least_side = 64;
        const int steps = std::max(1, least_side / std::min(width_px, height_px));
        if (steps == 1) return alphas;
        std::vector<float> all;
        for (int y = 0; y < height_px * steps; ++y)
            for (int x = 0; x < width_px * steps; ++x)
                all.push_back(between((static_cast<float>(x) + 0.5f) / static_cast<float>(steps) - 0.5f,
                                      (static_cast<float>(y) + 0.5f) / static_cast<float>(steps) - 0.5f));
        return all;
    }
};

AlphaPlane alphas_of(const TextureLevel& level) {
    AlphaPlane plane{level.size_px, level.size_px, {}};
    for (std::size_t i = 3; i < level.rgba.size(); i += 4)
        plane.alphas.push_back(static_cast<float>(level.rgba[i]) / 255.0f);
    return plane;
}

AlphaPlane alphas_of(const Image& level) {
    AlphaPlane plane{level.width_px, level.height_px, {}};
    for (std::size_t i = 3; i < level.rgba.size(); i += 4) plane.alphas.push_back(level.rgba[i]);
    return plane;
}

void scale_alphas(TextureLevel& level, double factor) {
    for (std::size_t i = 3; i < level.rgba.size(); i += 4)
        level.rgba[i] = static_cast<std::uint8_t>(std::min(level.rgba[i] * factor, 255.0) + 0.5);
}

void scale_alphas(Image& level, double factor) {
    for (std::size_t i = 3; i < level.rgba.size(); i += 4)
        level.rgba[i] = static_cast<float>(std::min(level.rgba[i] * factor, 1.0));
}

template <typename Level>
void keep(std::vector<Level>& levels, double alpha) {
    const std::vector<float> wanted = alphas_of(levels.front()).samples();
    const auto covered = static_cast<double>(std::ranges::count_if(wanted, [&](float one) { return one >= alpha; }));
    if (covered == 0) return;
    const double share = covered / static_cast<double>(wanted.size());
    for (auto level = levels.begin() + 1; level != levels.end(); ++level) {
        // The least alpha of the part that is to be covered becomes `alpha`.
        std::vector<float> samples = alphas_of(*level).samples();
        const auto rank = static_cast<std::size_t>(std::lround(share * static_cast<double>(samples.size())));
        const auto least = samples.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
        std::ranges::nth_element(samples, least, std::greater<>());
        if (*least > 0) scale_alphas(*level, alpha / *least);
    }
}

}  // namespace

void keep_alpha_coverage(std::vector<TextureLevel>& levels, double alpha) {
    keep(levels, alpha);
}

void keep_alpha_coverage(std::vector<Image>& levels, double alpha) {
    keep(levels, alpha);
}

}  // namespace sheer
