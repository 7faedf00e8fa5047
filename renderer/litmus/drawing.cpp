#include "renderer/litmus/drawing.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace sheer::litmus {

namespace {

/// The alpha of a fragment without any, whose color is to be added nevertheless.
constexpr double hardly_any = 1e-9;

void take_colors(Fragment& fragment, Colors colors) {
    if (colors == Colors::straight) return;
    if (colors == Colors::premultiplied) fragment.alpha = std::max(fragment.alpha, hardly_any);
    for (double& channel : fragment.color)
        channel = colors == Colors::premultiplied ? channel / fragment.alpha : channel * fragment.alpha;
}

void linearize(Color& color) {
    for (double& channel : color) channel = srgb_to_linear(channel);
}

}  // namespace

std::string name_of(Order order) {
    switch (order) {
        case Order::as_given:
            return "as submitted";
        case Order::far_to_near:
            return "sorted from far to near";
        case Order::near_to_far:
            return "sorted from near to far";
    }
    throw std::logic_error("unknown order");
}

std::string name_of(Colors colors) {
    switch (colors) {
        case Colors::straight:
            return "straight";
        case Colors::premultiplied:
            return "taken as premultiplied, so that alpha is not applied";
        case Colors::twice:
            return "multiplied by alpha twice";
    }
    throw std::logic_error("unknown colors");
}

std::string name_of(Blending blending) {
    switch (blending) {
        case Blending::encoded:
            return "sRGB-encoded values";
        case Blending::linear:
            return "linear values, sRGB-encoded afterwards";
        case Blending::linear_kept:
            return "linear values, not encoded afterwards";
    }
    throw std::logic_error("unknown blending");
}

Stack submitted(const Stack& stack, const Stack& by_middles, const Drawing& drawing) {
    Stack result = drawing.formula->sorts_primitives ? by_middles : stack;
    if (drawing.order != Order::as_given) {
        std::vector<std::size_t> places(stack.fragments.size());
        std::iota(places.begin(), places.end(), std::size_t{0});
        std::ranges::stable_sort(places, [&](std::size_t a, std::size_t b) {
            const float depth_a = by_middles.fragments[a].depth, depth_b = by_middles.fragments[b].depth;
            return drawing.order == Order::far_to_near ? depth_a > depth_b : depth_a < depth_b;
        });
        const std::vector<Fragment> before = result.fragments;
        for (std::size_t i = 0; i < places.size(); ++i) result.fragments[i] = before[places[i]];
    }
    if (drawing.blending != Blending::encoded) linearize(result.below);
    for (Fragment& fragment : result.fragments) {
        if (drawing.blending != Blending::encoded) linearize(fragment.color);
        take_colors(fragment, drawing.colors);
    }
    return result;
}

Color as_shown(const Color& color, Blending blending) {
    Color shown;
    for (std::size_t i = 0; i < 3; ++i) {
        // A driver's result that is no number is usually black.
        const double value = std::isfinite(color[i]) ? std::clamp(color[i], 0.0, 1.0) : 0;
        shown[i] = blending == Blending::linear ? linear_to_srgb(value) : value;
    }
    return shown;
}

double srgb_to_linear(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double linear_to_srgb(double linear) {
    return linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

}  // namespace sheer::litmus
