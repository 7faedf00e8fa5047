#include "tests/render/formulas.h"

#include <algorithm>
#include <cmath>

namespace sheer::test {

namespace {

/// Blends in 32-bit floats: some thousand roundings of 2^-24 and what the device's own arithmetic adds.
double float_bound(const Stack& stack) {
    return 1e-5 + 1e-6 * static_cast<double>(stack.fragments.size());
}

/// The least and the greatest value that a rounded number can have. With 8 bits, a shader's output is rounded before it
/// is blended, and the result afterwards, each to the nearest step; with 16-bit floats, each to 11 significant bits.
struct Range {
    double least, greatest;
};

Range rounded(Range range, PixelFormat format) {
    if (format == PixelFormat::rgba8)
        return {std::ceil(range.least * 255 - 0.501) / 255, std::floor(range.greatest * 255 + 0.501) / 255};
    return {range.least * (1 - 0x1p-11) - 0x1p-25, range.greatest * (1 + 0x1p-11) + 0x1p-25};
}

Range product(Range a, Range b) {
    return {std::max(a.least, 0.0) * std::max(b.least, 0.0), a.greatest * b.greatest};
}

Range sum(Range a, Range b) {
    return {a.least + b.least, a.greatest + b.greatest};
}

/// The sum of `a` and something that is blended onto it. `a` itself needs no rounding, so the sum is never further off
/// than what was added.
Range rounded_sum(Range a, Range added, PixelFormat format) {
    const Range all = rounded(sum(a, added), format);
    return {std::max(all.least, a.least), std::min(all.greatest, a.greatest + 2 * added.greatest)};
}

Range exactly(double value) {
    return {value, value};
}

/// A transmittance stored as 1 minus itself. Near 1, 16-bit floats have steps of 2^-11, and OpenGL lets a device
/// truncate smaller parts, as llvmpipe does: then 1 is never reached, and a step of transmittance always remains.
Range rounded_as_opacity(Range transmittance, PixelFormat format) {
    if (format == PixelFormat::rgba8) return rounded(transmittance, format);
    constexpr double step = 0x1p-11;
    return {std::ceil(transmittance.least / step - 0.501) * step,
            std::floor(transmittance.greatest / step + 0.999) * step};
}

double front_to_back(const Stack& stack, PixelFormat format, Range (*round_transmittance)(Range, PixelFormat)) {
    if (format == PixelFormat::rgba32f) return float_bound(stack);
    const Stack far_to_near = sorted(stack);
    const Color truth = over(far_to_near);
    double greatest = 0;
    for (std::size_t channel = 0; channel < 3; ++channel) {
        Range color = exactly(0), transmittance = exactly(1);
        for (auto fragment = far_to_near.fragments.rbegin(); fragment != far_to_near.fragments.rend(); ++fragment) {
            const Range source = rounded(exactly(fragment->alpha * fragment->color[channel]), format);
            color = rounded_sum(color, product(transmittance, source), format);
            const Range left = rounded(exactly(1 - fragment->alpha), format);
            transmittance = round_transmittance(product(transmittance, left), format);
        }
        const Range below = rounded(exactly(stack.below[channel]), format);
        const Range all = rounded(sum(color, product(transmittance, below)), format);
        greatest = std::max({greatest, truth[channel] - all.least, all.greatest - truth[channel]});
    }
    return greatest + 0.5 * step_of(format);
}

}  // namespace

double step_of(PixelFormat format) {
    return format == PixelFormat::rgba8 ? 1.0 / 255 : format == PixelFormat::rgba16f ? 0x1p-10 : 0x1p-23;
}

double rounded_once(const Stack& stack, PixelFormat format) {
    return format == PixelFormat::rgba32f ? float_bound(stack) : 0.501 * step_of(format);
}

double rounded_back_to_front(const Stack& stack, PixelFormat format) {
    if (format == PixelFormat::rgba32f) return float_bound(stack);
    double bound = 0.5 * step_of(format);  // the opaque picture
    for (const Fragment& fragment : sorted(stack).fragments)
        bound = bound * (1 - fragment.alpha) + 1.5 * step_of(format);
    return bound;
}

double rounded_front_to_back(const Stack& stack, PixelFormat format) {
    return front_to_back(stack, format, rounded);
}

double rounded_with_opacity(const Stack& stack, PixelFormat format) {
    return front_to_back(stack, format, rounded_as_opacity);
}

double sample_variance(const Stack& stack) {
    return std::ranges::max(litmus::variance_of_sample(stack));
}

double mean_bound(double variance, double samples) {
    // P(|mean - expected| >= t) <= 2 exp(-n t^2 / (2 variance + 2 t / 3)), solved for t.
    const double logarithm = std::log(2 * 1e5 * 1e3), linear = logarithm / (3 * samples);
    return linear + std::sqrt(linear * linear + 2 * variance * logarithm / samples);
}

}  // namespace sheer::test
