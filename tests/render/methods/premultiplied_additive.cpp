#include "tests/render/method_row.h"

#include <algorithm>

namespace sheer::test {

namespace {

/// In 16-bit floats each of n additions rounds a sum of up to n, each of n factors is off by 2^-11 and rounded.
double emitted_bound(const Stack& stack, PixelFormat format) {
    const auto layers = static_cast<double>(stack.fragments.size());
    if (format == PixelFormat::rgba32f) return 1e-5 + 1e-6 * layers;
    double alphas = 0;
    for (const Fragment& fragment : stack.fragments) alphas += fragment.alpha;
    return (layers + 1) * (alphas + 1) * 0x1p-10 + step_of(format);
}

}  // namespace

MethodRow row_premultiplied_additive() {
    return {
        .id = "premultiplied_additive",
        .formula = formula_of("premultiplied_additive"),
        .variants = {{nlohmann::json::object(), emitted_bound},
                     {{{"coverage", 1}}, emitted_bound},
                     {{{"coverage", 0.375}}, emitted_bound}},
        .litmus =
            {{"",
              {nlohmann::json::object()},
              {{{"shuffled"}, passes, "a sum does not depend on the order, except for the rounding of each addition"},
               {{"overflow"}, fails, "31 times the color is added"},
               {{"self_overlap"}, fails, "both colors are added"},
               {{"fade"}, fails, "all surfaces of the model are added"},
               {{"unequal", "window", "close_pair", "interleaved"}, fails, "all colors are added"},
               {{"black", "white", "checker", "alpha_to_1", "glass", "leaves", "opaque_behind", "64_layers"},
                fails,
                "fragments hide neither each other nor the background; all colors are added and clamped to white"},
               {{"opaque_between", "one_layer"}, fails, "the background is not darkened: too bright by alpha times D"},
               {{"alpha_to_0"},
                passes,
                "six layers of 1/128 hide little of each other and, of a background of at most 0.15, two levels"},
               {{"opaque_front"}, passes, "the depth test hides what is behind"}}},
             {"premultiplied_additive, covering",
              {{{"coverage", 1}}},
              {{{"shuffled"}, passes, "sum and product do not depend on the order, except for rounding"},
               {{"overflow"}, fails, "the background is right, but 31 times the color is added"},
               {{"self_overlap"}, fails, "the background is right, but both colors are added"},
               {{"fade"}, fails, "all surfaces of the model are added"},
               {{"unequal", "window", "close_pair", "interleaved"},
                fails,
                "the background is right, but all colors are added"},
               {{"black", "white", "checker", "alpha_to_1", "glass", "leaves", "opaque_behind", "64_layers"},
                fails,
                "the background is right, but fragments do not hide each other: for two layers of 0.5 too bright by a "
                "quarter of the farther one's color"},
               {{"opaque_between", "one_layer"},
                passes,
                "one layer is added to what it does not cover: the over operator"},
               {{"alpha_to_0"}, passes, "faint layers hardly hide each other"},
               {{"opaque_front"}, passes, "the depth test hides what is behind"}}}},
    };
}

}  // namespace sheer::test
