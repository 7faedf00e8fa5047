#include "tests/render/method_row.h"

#include <algorithm>

namespace sheer::test {

namespace {

/// The sum of n alphas is off by n half steps, but is clamped to 1; the square is off by twice that. Two pictures and
/// the result are rounded.
double mask_bound(const Stack& stack, PixelFormat format) {
    if (format == PixelFormat::rgba32f) return 1e-5 + 1e-6 * static_cast<double>(stack.fragments.size());
    double sum = 0, off = 0;
    for (const Fragment& fragment : stack.fragments) {
        sum += fragment.alpha;
        off += 0.5 * step_of(format) * std::max(1.0, format == PixelFormat::rgba8 ? 1.0 : sum);
    }
    const double off_when_cut = std::min(sum + off, 1.0) - std::clamp(sum - off, 0.0, 1.0);
    return 2 * off_when_cut + 2.5 * step_of(format);
}

}  // namespace

MethodRow row_ssam() {
    return {
        .id = "ssam",
        .formula = formula_of("ssam"),
        .variants = {{nlohmann::json::object(), mask_bound},
                     {{{"opaque_msaa", 2}}, mask_bound},
                     {{{"drawn_after", 2}}, mask_bound}},
        .litmus =
            {{"",
              {nlohmann::json::object(), {{"opaque_msaa", 2}}},
              {{{"shuffled"}, passes, "maximum, saturated sum and nearest color do not depend on the order"},
               {{"overflow"}, passes, "the mask saturates and the nearest color has all of it"},
               {{"self_overlap"}, fails, "only the nearest color with enough alpha shows, and the mask saturates"},
               {{"fade"},
                fails,
                "the color is that of the nearest surface, but the mask is that of the sum of the alphas, squared"},
               {{"unequal", "window", "close_pair", "interleaved"},
                fails,
                "only the nearest color with enough alpha shows, and the mask is that of the sum of the alphas"},
               {{"black", "white", "checker", "opaque_behind", "glass"},
                fails,
                "only the nearest color shows, and the mask of several layers of 0.5 saturates"},
               {{"opaque_between", "one_layer"},
                fails,
                "the mask is squared: one layer of 0.5 has the weight 0.25; under 64/255 it has no color either"},
               {{"alpha_to_0"},
                fails,
                "a mask of 0.04 vanishes when squared, and no fragment reaches the alpha reference"},
               {{"alpha_to_1", "leaves"}, passes, "the mask tends to 1, and the nearest color is found per pixel"},
               {{"opaque_front"}, passes, "mask and color are drawn against the opaque depth"},
               {{"64_layers"},
                fails,
                "no fragment reaches the alpha reference, so a saturated mask blends to the clear color"}}}},
    };
}

}  // namespace sheer::test
