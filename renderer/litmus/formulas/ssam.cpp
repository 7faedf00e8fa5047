#include "renderer/litmus/formula.h"

#include <algorithm>

namespace sheer::litmus {

namespace {

struct MaskParameters {
    double additive_part, alpha_reference;
    bool squared;
    Color clear_color;
    std::size_t drawn_after;
};

MaskParameters mask_parameters(const nlohmann::json& parameters) {
    const std::string mask = parameters.value("mask", "combined");
    return {mask == "max"        ? 0
            : mask == "additive" ? 1
                                 : parameters.value("mask_lerp", 0.85),
            parameters.value("alpha_reference", 64.0 / 255), parameters.value("squared", true),
            parameters.value("clear_color", Color{}), parameters.value("drawn_after", std::size_t{0})};
}

/// Hathaway's Listing 3.2; no fragment from the reference up shows the clear color.
Color mask(const Stack& stack, const MaskParameters& of) {
    double greatest = 0, sum = 0;
    for (const Fragment& fragment : stack.fragments) {
        greatest = std::max(greatest, fragment.alpha);
        sum += fragment.alpha;
    }
    const double weight = (1 - of.additive_part) * greatest + of.additive_part * std::min(sum, 1.0);
    return mix(stack.below, nearest_of(stack, of.alpha_reference, of.clear_color),
               of.squared ? weight * weight : weight);
}

/// The mask of all but the last `drawn_after` layers as submitted; these are over it if they are not behind its
/// foliage, which is the nearest fragment from the reference up.
Color mask_and_after(const Stack& stack, const MaskParameters& of) {
    Stack foliage{stack.below, {}}, after;
    float foliage_depth = 2;
    for (const Fragment& fragment : stack.fragments)
        if (fragment.submitted + of.drawn_after < stack.transparent_layers) {
            foliage.fragments.push_back(fragment);
            if (fragment.alpha >= of.alpha_reference) foliage_depth = std::min(foliage_depth, fragment.depth);
        }
    for (const Fragment& fragment : stack.fragments)
        if (fragment.submitted + of.drawn_after >= stack.transparent_layers && fragment.depth <= foliage_depth)
            after.fragments.push_back(fragment);
    after.below = mask(foliage, of);
    return over_by_depth(after);
}

}  // namespace

FormulaInfo formula_ssam() {
    return {.id = "ssam",
            .name = "screen-space alpha masking",
            .make = [](const nlohmann::json& parameters) -> Formula {
                return [of = mask_parameters(parameters)](const Stack& stack) { return mask_and_after(stack, of); };
            },
            .weighs_by_alpha = false,
            .variants = {nlohmann::json::object(),
                         {{"squared", false}},
                         {{"mask", "max"}},
                         {{"mask", "max"}, {"squared", false}},
                         {{"mask", "additive"}},
                         {{"mask", "additive"}, {"squared", false}}}};
}

}  // namespace sheer::litmus
