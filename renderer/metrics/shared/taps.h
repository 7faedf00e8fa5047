#pragma once
#include <array>
#include <cmath>
#include <cstddef>

namespace sheer {

/// One half of a filter of 2 * Radius + 1 taps that is symmetric or antisymmetric: [0] is the centre, [k] belongs to
/// +k; the tap at -k is the same (even) or its negative (odd; the centre is then 0).
template <int Radius>
using Taps = std::array<float, Radius + 1>;

/// exp(-x^2 / (2 sigma^2)) at whole x, scaled so that all taps sum to 1; taps beyond `cut` are 0.
template <int Radius>
Taps<Radius> gaussian_taps(double sigma_px, int cut = Radius) {
    std::array<double, Radius + 1> weights{};
    double sum = 0;
    for (int k = 0; k <= cut; ++k) {
        weights[k] = std::exp(-k * k / (2 * sigma_px * sigma_px));
        sum += k == 0 ? weights[k] : 2 * weights[k];
    }
    Taps<Radius> taps{};
    double others = 0;
    for (int k = 1; k <= cut; ++k) {
        taps[k] = float(weights[k] / sum);
        others += 2.0 * taps[k];
    }
    taps[0] = float(1 - others);  // absorbs the rounding of the others, so that constants are unchanged
    return taps;
}

/// The filter's value around `centre`, whose neighbours are `Step` apart. The compiler knows all sizes, so it
/// vectorizes a loop over neighbouring centres.
template <int Radius, std::ptrdiff_t Step>
inline float even_sum(const float* centre, const Taps<Radius>& taps) {
    float sum = taps[0] * centre[0];
    for (int k = 1; k <= Radius; ++k) sum += taps[k] * (centre[k * Step] + centre[-k * Step]);
    return sum;
}

template <int Radius, std::ptrdiff_t Step>
inline float odd_sum(const float* centre, const Taps<Radius>& taps) {
    float sum = 0;
    for (int k = 1; k <= Radius; ++k) sum += taps[k] * (centre[k * Step] - centre[-k * Step]);
    return sum;
}

}  // namespace sheer
