#include "renderer/litmus/over.h"

#include <algorithm>
#include <functional>

namespace sheer::litmus {

Color mix(const Color& a, const Color& b, double weight_of_b) {
    Color mixed;
    for (std::size_t i = 0; i < 3; ++i) mixed[i] = (1 - weight_of_b) * a[i] + weight_of_b * b[i];
    return mixed;
}

Stack sorted(Stack stack) {
    std::ranges::stable_sort(stack.fragments, std::greater(), &Fragment::depth);
    return stack;
}

Color over(const Stack& stack) {
    Color color = stack.below;
    for (const Fragment& fragment : stack.fragments) color = mix(color, fragment.color, fragment.alpha);
    return color;
}

Color over_by_depth(const Stack& stack) {
    return over(sorted(stack));
}

Color nearest_of(const Stack& stack, double least_alpha, const Color& otherwise) {
    float nearest_depth = 2;
    Color color = otherwise;
    for (const Fragment& fragment : stack.fragments) {
        if (fragment.alpha < least_alpha || fragment.depth > nearest_depth) continue;
        nearest_depth = fragment.depth;
        color = fragment.color;
    }
    return color;
}

Color variance_of_sample(const Stack& stack) {
    Stack squared = stack;
    for (double& channel : squared.below) channel *= channel;
    for (Fragment& fragment : squared.fragments)
        for (double& channel : fragment.color) channel *= channel;
    const Color mean = over_by_depth(stack);
    Color variance = over_by_depth(squared);
    for (std::size_t i = 0; i < 3; ++i) variance[i] = std::max(0.0, variance[i] - mean[i] * mean[i]);
    return variance;
}

}  // namespace sheer::litmus
