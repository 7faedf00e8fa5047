#pragma once
#include <string>

#include "renderer/litmus/formula.h"

namespace sheer::litmus {

/// In which order primitives are submitted to a formula for which that matters.
enum class Order { as_given, far_to_near, near_to_far };
/// What is taken for the colors of a scene, which are not multiplied by alpha: that (straight); colors that are
/// already, so that alpha is not applied (premultiplied); or colors to which alpha is applied twice (twice).
enum class Colors { straight, premultiplied, twice };
/// Which values are blended: those of the picture, sRGB-encoded; linear ones, encoded afterwards; or linear ones that
/// are kept as they are.
enum class Blending { encoded, linear, linear_kept };

std::string name_of(Order order);
std::string name_of(Colors colors);
std::string name_of(Blending blending);

/// A way to draw a picture.
struct Drawing {
    const FormulaInfo* formula = nullptr;
    nlohmann::json parameters = nlohmann::json::object();
    Order order = Order::as_given;
    Colors colors = Colors::straight;
    Blending blending = Blending::encoded;
};

/// A pixel as the formula gets it: `by_middles` are the same fragments with the depths of their primitives' middles.
Stack submitted(const Stack& stack, const Stack& by_middles, const Drawing& drawing);

/// What a formula gives for such a stack, as in the picture: 0 to 1.
Color as_shown(const Color& color, Blending blending);
/// IEC 61966-2-1, of 0 to 1.
double srgb_to_linear(double encoded);
double linear_to_srgb(double linear);

}  // namespace sheer::litmus
