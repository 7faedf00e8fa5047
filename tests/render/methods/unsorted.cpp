#include "tests/render/method_row.h"

namespace sheer::test {

namespace {

/// As from far to near, in the order of submission.
double rounded_as_submitted(const Stack& stack, PixelFormat format) {
    Stack as_submitted = stack;
    for (Fragment& fragment : as_submitted.fragments) fragment.depth = 0;
    return rounded_back_to_front(as_submitted, format);
}

}  // namespace

MethodRow row_unsorted() {
    return {
        .id = "unsorted",
        .formula = [](const nlohmann::json&) -> Formula { return over; },
        .variants = {{nlohmann::json::object(), rounded_as_submitted}},
        .litmus =
            {{"",
              {nlohmann::json::object()},
              {{{"shuffled"}, fails, "what is submitted last is on top"},
               {{"overflow"}, passes, "it sums nothing that could overflow; of one color, the layers have no order"},
               {{"self_overlap"}, fails, "the part within is submitted last, so it is on top"},
               {{"fade"}, fails, "the farthest surface is submitted last, so it is on top"},
               {{"unequal", "window", "close_pair"},
                fails,
                "the layers are submitted from near to far, so the farthest is on top"},
               {{"interleaved"}, fails, "number 9 in depth is submitted last and so is on top"},
               {{"black", "white", "checker", "opaque_behind", "alpha_to_1", "64_layers"},
                fails,
                "the layers are submitted from near to far, so the farthest is on top"},
               {{"alpha_to_0"},
                passes,
                "swapping two layers changes their color by the product of their alphas, at most 1/16384"},
               {{"one_layer", "opaque_between"}, passes, "one visible layer has no order"},
               {{"opaque_front"}, passes, "the depth test hides what is behind"},
               {{"glass", "leaves"},
                fails,
                "a primitive is drawn whole, so one side of the cut has the wrong order"}}}},
    };
}

}  // namespace sheer::test
