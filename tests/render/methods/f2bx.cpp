#include "tests/render/method_row.h"

namespace sheer::test {

// The transmittance starts at 0, so neither layers nor background come through.
MethodRow row_f2bx() {
    return {
        .id = "f2bx",
        .formula = [](const nlohmann::json&) -> Formula { return [](const Stack&) { return Color{}; }; },
        .variants = {{nlohmann::json::object()}, {{{"inverted", false}}}},
        .litmus = {{"",
                    {nlohmann::json::object()},
                    {{{"shuffled"}, passes, "the picture is black in any order"},
                     {{"overflow", "self_overlap", "fade"}, fails, "black: nothing comes through"},
                     {{"black", "white", "checker", "alpha_to_0", "alpha_to_1", "glass", "leaves", "opaque_front",
                       "opaque_behind", "opaque_between", "one_layer", "64_layers", "unequal", "window", "close_pair",
                       "interleaved"},
                      fails,
                      "the transmittance starts at 0, so nothing comes through; it measures speed only"}}}},
    };
}

}  // namespace sheer::test
