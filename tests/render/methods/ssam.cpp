#include "tests/render/method_row.h"

#include <algorithm>

namespace sheer::test {

namespace {

constexpr double alpha_reference = 64.0 / 255;

/// Hathaway's Listing 3.2 with the defaults: 85 % additive, squared, color from the reference up, otherwise black.
Color mask(const Stack& stack) {
    double greatest = 0, sum = 0;
    for (const Fragment& fragment : stack.fragments) {
        greatest = std::max(greatest, fragment.alpha);
        sum += fragment.alpha;
    }
    const double weight = 0.15 * greatest + 0.85 * std::min(sum, 1.0);
    return mix(stack.below, nearest_of(stack, alpha_reference, {0, 0, 0}), weight * weight);
}

/// The mask of all but the last `count` layers as submitted; these are over it if they are not behind its foliage,
/// which is the nearest fragment from the reference up.
Color mask_and_after(const Stack& stack, std::size_t count) {
    Stack foliage{stack.below, {}}, after;
    float foliage_depth = 2;
    for (const Fragment& fragment : stack.fragments)
        if (fragment.submitted + count < stack.transparent_layers) {
            foliage.fragments.push_back(fragment);
            if (fragment.alpha >= alpha_reference) foliage_depth = std::min(foliage_depth, fragment.depth);
        }
    for (const Fragment& fragment : stack.fragments)
        if (fragment.submitted + count >= stack.transparent_layers && fragment.depth <= foliage_depth)
            after.fragments.push_back(fragment);
    after.below = mask(foliage);
    return over_by_depth(after);
}

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
        .formula = [](const nlohmann::json& parameters) -> Formula {
            const auto after = parameters.value("drawn_after", std::size_t{0});
            return [after](const Stack& stack) { return mask_and_after(stack, after); };
        },
        .variants = {{nlohmann::json::object(), mask_bound},
                     {{{"opaque_msaa", 2}}, mask_bound},
                     {{{"drawn_after", 2}}, mask_bound}},
        .litmus =
            {{"",
              {nlohmann::json::object(), {{"opaque_msaa", 2}}},
              {{{"shuffled"}, passes, "maximum, saturated sum and nearest color do not depend on the order"},
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
