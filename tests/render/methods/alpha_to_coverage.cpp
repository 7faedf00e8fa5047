#include "tests/render/method_row.h"

namespace sheer::test {

namespace {

/// Each sample is rounded, and so is their mean.
double samples_bound(const Stack&, PixelFormat format) {
    return format == PixelFormat::rgba32f ? 1e-5 : step_of(format);
}

}  // namespace

MethodRow row_alpha_to_coverage() {
    return {
        .id = "alpha_to_coverage",
        .formula = formula_of("alpha_to_coverage"),
        .variants = {{nlohmann::json::object(), samples_bound, true}},
        .litmus = {{"",
                    {nlohmann::json::object()},
                    {{{"shuffled"}, passes, "in each sample the nearest fragment wins by the depth test"},
                     {{"overflow"}, passes, "alpha 0.96 covers all four samples"},
                     {{"self_overlap"}, fails, "0.4 covers two of four samples and 0.8 all of them"},
                     {{"fade"},
                      passes,
                      "all surfaces of a pixel cover the same samples, one to four of four, so the nearest hides the "
                      "others in each"},
                     {{"unequal", "window", "close_pair", "interleaved"},
                      fails,
                      "four samples have five levels of coverage, and a near layer hides a far one in all samples that "
                      "both cover"},
                     {{"black", "white", "checker", "opaque_behind", "glass", "64_layers"},
                      fails,
                      "layers of equal alpha cover the same samples, so the nearest hides the others completely"},
                     {{"alpha_to_0", "one_layer"}, fails, "four samples have five levels of coverage"},
                     {{"opaque_between"}, passes, "one layer of 0.5 is two of four samples"},
                     {{"alpha_to_1", "leaves"},
                      passes,
                      "all samples are covered and the depth test decides in each: off by at most 1/128"},
                     {{"opaque_front"}, passes, "the depth test hides what is behind"}}}},
    };
}

}  // namespace sheer::test
