#pragma once
#include "renderer/litmus/stack.h"

namespace sheer::litmus {

/// (1 - weight) a + weight b.
Color mix(const Color& a, const Color& b, double weight_of_b);

/// The fragments from far to near; of equal depths, the one submitted later is nearer.
Stack sorted(Stack stack);

/// The over operator, from the first fragment to the last.
Color over(const Stack& stack);
/// The same from far to near: the correct result.
Color over_by_depth(const Stack& stack);
/// The nearest fragment with at least this alpha; of equal depths, the one submitted later.
Color nearest_of(const Stack& stack, double least_alpha, const Color& otherwise);

/// The variance of a sample that shows one of the pixel's surfaces, each as often as its weight in the correct result.
Color variance_of_sample(const Stack& stack);

}  // namespace sheer::litmus
