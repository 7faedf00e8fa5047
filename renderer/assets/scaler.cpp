#include "renderer/assets/scaler.h"

#include <algorithm>
#include <cmath>

namespace sheer {

namespace {

/// Keys (1981) with a = -1/2; `x` is the distance in source pixels.
double catmull_rom(double x) {
    x = std::abs(x);
    if (x >= 2) return 0;
    return x < 1 ? 1 + x * x * (1.5 * x - 2.5) : 2 + x * (-4 + x * (2.5 - 0.5 * x));
}

}  // namespace

Scaler::Scaler(int source_width, int source_height, int target_width, int target_height)
    : m_width(target_width),
      m_height(target_height),
      m_columns(make_taps(source_width, target_width)),
      m_rows(make_taps(source_height, target_height)),
      m_row(static_cast<std::size_t>(target_width) * channels),
      m_sums(m_row.size() * static_cast<std::size_t>(target_height)) {}

std::vector<std::vector<Scaler::Tap>> Scaler::make_taps(int source, int target) {
    std::vector<std::vector<Tap>> taps(static_cast<std::size_t>(source));
    const double step = static_cast<double>(source) / target;
    const auto add = [&](int from, int to, double weight) {
        const int inside = std::clamp(from, 0, source - 1);
        if (weight != 0) taps[static_cast<std::size_t>(inside)].push_back({to, static_cast<float>(weight)});
    };
    for (int to = 0; to < target; ++to) {
        if (target < source) {
            const double begin = to * step, end = (to + 1) * step;
            for (int from = static_cast<int>(begin); from < end; ++from)
                add(from, to, (std::min(end, from + 1.0) - std::max(begin, static_cast<double>(from))) / step);
        } else {
            const double centre = (to + 0.5) * step - 0.5;
            const int nearest = static_cast<int>(std::floor(centre));
            for (int from = nearest - 1; from <= nearest + 2; ++from) add(from, to, catmull_rom(centre - from));
        }
    }
    return taps;
}

void Scaler::add_row(int y, const float* rgba) {
    std::ranges::fill(m_row, 0.0f);
    for (const std::vector<Tap>& taps : m_columns) {
        const float alpha = rgba[3];
        const float values[channels] = {rgba[0] * alpha, rgba[1] * alpha, rgba[2] * alpha, alpha,
                                        rgba[0],         rgba[1],         rgba[2]};
        for (const Tap& tap : taps) {
            float* out = &m_row[static_cast<std::size_t>(tap.target) * channels];
            for (int channel = 0; channel < channels; ++channel) out[channel] += tap.weight * values[channel];
        }
        rgba += 4;
    }
    for (const Tap& tap : m_rows[static_cast<std::size_t>(y)]) {
        float* out = &m_sums[static_cast<std::size_t>(tap.target) * m_row.size()];
        for (std::size_t i = 0; i < m_row.size(); ++i) out[i] += tap.weight * m_row[i];
    }
}

Image Scaler::finish() const {
    Image image(m_width, m_height);
    const float* sums = m_sums.data();
    for (std::size_t i = 0; i < image.pixel_count(); ++i, sums += channels) {
        float* out = &image.rgba[i * 4];
        const float alpha = sums[3];
        for (int channel = 0; channel < 3; ++channel)
            out[channel] = std::max(alpha > 0 ? sums[channel] / alpha : sums[4 + channel], 0.0f);
        out[3] = std::clamp(alpha, 0.0f, 1.0f);
    }
    return image;
}

}  // namespace sheer
