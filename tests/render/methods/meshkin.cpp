#include "tests/render/method_row.h"

#include <cmath>

namespace sheer::test {

namespace {

/// The sums of n colors and n alphas reach n and are rounded n times, in 16-bit floats unless the image has 32. The
/// opaque picture, rounded by half a step, has a weight of at most n.
double simple_bound(const Stack& stack, PixelFormat format) {
    const auto layers = static_cast<double>(stack.fragments.size());
    if (format == PixelFormat::rgba32f) return 1e-5 * std::max(layers, 1.0);
    return layers * (layers + 1) * 0x1p-11 + (format == PixelFormat::rgba8 ? 0.5 * (layers + 1) / 255 : 0x1p-11);
}

/// In addition to the sums, the product, which is rounded n times, times the reciprocals: at most n.
double full_bound(const Stack& stack, PixelFormat format) {
    const auto layers = static_cast<double>(stack.fragments.size());
    const double more = format == PixelFormat::rgba8 ? 0.5 * layers / 255 : 0;
    if (format == PixelFormat::rgba32f) return simple_bound(stack, format);
    return simple_bound(stack, format) + layers * layers * 0x1p-10 + more;
}

}  // namespace

MethodRow row_meshkin() {
    return {
        .id = "meshkin",
        .formula = formula_of("meshkin"),
        .variants = {{nlohmann::json::object(), simple_bound}, {{{"variant", "full"}}, full_bound}},
        .litmus =
            {{"meshkin, simple",
              {nlohmann::json::object()},
              {{{"shuffled"}, passes, "sums do not depend on the order, except for the rounding of each addition"},
               {{"overflow"}, fails, "the alphas sum to 31, so the background is subtracted 30 times too often"},
               {{"self_overlap"}, fails, "the product of 0.4 and 0.8 is left out"},
               {{"fade"}, fails, "what is left out matters from alpha 0.25 up, and no model is known"},
               {{"unequal", "window", "close_pair", "interleaved"},
                fails,
                "what is left out grows with the products of the alphas, and the background is subtracted more often "
                "than there is of it"},
               {{"black", "white", "checker", "opaque_behind", "glass"},
                fails,
                "at alpha 0.5 the omitted products matter: for two layers 0.25 of background minus far color, on "
                "both sides of an intersection"},
               {{"alpha_to_1", "leaves"},
                fails,
                "four layers of alpha 1 are off by 3 D - C0 - C1 - C2 (slide 21), two by D - C0"},
               {{"alpha_to_0"},
                passes,
                "what is left out shrinks with the square of alpha: at most 15/16384 of the background for six "
                "layers"},
               {{"opaque_front"}, passes, "the depth test hides what is behind"},
               {{"opaque_between", "one_layer"}, passes, "for one layer D + S - D A is the over operator"},
               {{"64_layers"}, fails, "the alphas sum to 4, so the background is subtracted three times too often"}}},
             {"meshkin, full",
              {{{"variant", "full"}}},
              {{{"shuffled"},
                passes,
                "sums and products do not depend on the order, except for the rounding of each step"},
               {{"overflow"},
                fails,
                "the product of 32 alphas times the sum of their reciprocals is no picture of anything but four "
                "layers, and the colors sum to 31 times their brightness"},
               {{"self_overlap"}, fails, "its additional terms are those of four layers"},
               {{"fade"}, fails, "its additional terms are those of four layers, and no model is known"},
               {{"unequal", "window", "close_pair", "interleaved"},
                fails,
                "what is left out grows with the products of the alphas, and its additional terms are those of four "
                "layers"},
               {{"black", "white", "checker"},
                fails,
                "what is left out matters at alpha 0.5, and the terms of the reciprocals are those of four layers, not "
                "three"},
               {{"opaque_behind", "opaque_between", "one_layer", "glass"},
                fails,
                "one layer gives A C with no part of the background, two lose as much: full is derived for four"},
               {{"alpha_to_1", "leaves"},
                fails,
                "four layers of alpha 1 are off by 6 D - C0 - C1 - C2 (slide 19), two by 2 D - C0"},
               {{"alpha_to_0"},
                passes,
                "its additional terms shrink with the fifth power of alpha here, the omitted ones with the square"},
               {{"opaque_front"}, passes, "the depth test hides what is behind"},
               {{"64_layers"},
                fails,
                "the product of 64 alphas vanishes, so it equals simple, which subtracts the background three times "
                "over"}}}},
    };
}

}  // namespace sheer::test
