#include "tests/render/method_row.h"

#include <algorithm>
#include <cmath>

namespace sheer::test {

namespace {

/// Computed in 32-bit floats; the opaque picture and the result are rounded.
double rounded_twice(const Stack& stack, PixelFormat format) {
    return format == PixelFormat::rgba32f ? rounded_once(stack, format) : 1.01 * step_of(format);
}

std::vector<LitmusExpectation> nearest_expectations(const std::string& of_64_layers,
                                                    const LitmusExpectation& of_interleaved) {
    return {
        {{"shuffled"}, passes, "the least keys are the same in any order"},
        {{"overflow"}, passes, "the nearest eight let nothing through"},
        {{"self_overlap"}, passes, "it sorts the fragments of each pixel, not primitives"},
        {{"fade"},
         fails,
         "the inside of a model shows, as of any layers of that alpha: it does not know that they are one model"},
        {{"black", "white", "checker", "alpha_to_0", "alpha_to_1", "one_layer"},
         passes,
         "up to eight layers are kept, and blended with transmittances rounded to 1/255: off by less than a level per "
         "layer"},
        {{"opaque_front", "opaque_behind", "opaque_between"},
         passes,
         "both passes are tested against the opaque depth"},
        {{"glass", "leaves"}, passes, "it sorts the fragments of each pixel, not primitives"},
        {{"64_layers"}, fails, of_64_layers},
        {{"unequal", "window", "close_pair"}, passes, "three layers are among the eight nearest"},
        of_interleaved};
}

}  // namespace

MethodRow row_nearest_k() {
    return {
        .id = "nearest_k",
        .formula = formula_of("nearest_k"),
        .variants = {{nlohmann::json::object(), rounded_twice},
                     {{{"rest", "dropped"}}, rounded_twice},
                     {{{"rest", "transmittance"}, {"k", 3}}, rounded_twice},
                     {{{"k", 1}}, rounded_twice},
                     {{{"k", 32}}, rounded_twice}},
        .litmus = {{"nearest_k, rest averaged",
                    {nlohmann::json::object()},
                    nearest_expectations(
                        "the average of the layers behind the eight nearest mixes the blue of the next 24 "
                        "with the green of the farthest",
                        {{"interleaved"},
                         passes,
                         "the average of the eight layers behind has nearly their color, and 6 % of the weight"})},
                   {"nearest_k, rest dropped",
                    {{{"rest", "dropped"}}},
                    nearest_expectations(
                        "the background shines through the eight nearest as if the others were not "
                        "there",
                        {{"interleaved"},
                         fails,
                         "the background shows with 0.7 to the power of 8, 6 %, instead of the eight layers behind"})},
                   {"nearest_k, rest darkens",
                    {{{"rest", "transmittance"}}},
                    nearest_expectations(
                        "the blue and green behind the eight nearest are missing",
                        {{"interleaved"}, fails, "6 % of the color, that of the eight layers behind, is missing"})}},
    };
}

}  // namespace sheer::test
