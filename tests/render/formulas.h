#pragma once
#include "renderer/image/image_spec.h"
#include "renderer/litmus/formula.h"

namespace sheer::test {

using namespace litmus;

/// How far a method's pixel may be from its formula because of rounding alone; it must not be outside 0 to 1.
using Bound = std::function<double(const Stack& stack, PixelFormat format)>;

/// A step of the format near 1, which bounds one rounding of a color and of what it is blended with.
double step_of(PixelFormat format);
/// Computed in floats and rounded to the format once.
double rounded_once(const Stack& stack, PixelFormat format);
/// Blended from far to near in the format: each layer rounds and lets only a part of the errors behind it through.
double rounded_back_to_front(const Stack& stack, PixelFormat format);
/// Blended from near to far in the format, in an accumulation that is laid over the opaque picture at the end: the
/// extremes that color and transmittance can reach, including each layer's own rounding.
double rounded_front_to_back(const Stack& stack, PixelFormat format);
/// The same if the accumulation keeps the opacity, whose steps do not get finer with the transmittance.
double rounded_with_opacity(const Stack& stack, PixelFormat format);

/// The variance of a sample that shows one of the pixel's surfaces, each as often as its weight in the correct result;
/// that of the channel where it is greatest.
double sample_variance(const Stack& stack);
/// How far the mean of `samples` independent numbers from 0 to 1 with this variance may be from what is expected, but
/// for one picture in a thousand of up to 10^5 numbers: Bernstein's inequality, which needs no normal distribution.
double mean_bound(double variance, double samples);

}  // namespace sheer::test
