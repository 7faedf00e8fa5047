#include "tests/render/method_row.h"

#include <algorithm>
#include <ranges>

namespace sheer::test {

namespace {

/// With 16-bit nodes each insertion may round each of the nodes it goes through.
double nodes_bound(const Stack& stack, PixelFormat format) {
    if (format == PixelFormat::rgba32f) return rounded_once(stack, format);
    return std::min(1.0, 2 * static_cast<double>(stack.fragments.size() + 4) * 0x1p-10) + step_of(format);
}

}  // namespace

MethodRow row_mlab() {
    return {
        .id = "mlab",
        .formula = formula_of("mlab"),
        .variants = {{nlohmann::json::object(), nodes_bound},
                     {{{"nodes", 2}}, nodes_bound},
                     {{{"nodes", 3}}, nodes_bound},
                     {{{"nodes", 5}}, nodes_bound},
                     {{{"nodes", 6}}, nodes_bound}},
        .litmus =
            {{"",
              {nlohmann::json::object()},
              {{{"shuffled"}, fails, "where more than four layers overlap, one may come between two that were merged"},
               {{"overflow"}, passes, "nodes are merged, not summed"},
               {{"self_overlap"}, passes, "it sorts the fragments of each pixel, not primitives"},
               {{"fade"},
                fails,
                "the inside of a model shows, as of any layers of that alpha: it does not know that they are one "
                "model"},
               {{"unequal", "window", "close_pair"}, passes, "three layers are nodes of their own"},
               {{"interleaved"},
                passes,
                "only what is behind three nodes is merged in the wrong order, and they let a third through"},
               {{"black", "white", "checker", "alpha_to_1", "one_layer"},
                passes,
                "up to four layers are nodes of their own"},
               {{"alpha_to_0", "64_layers"},
                passes,
                "the layers are submitted from near to far, so each that finds no room is directly behind the last "
                "node"},
               {{"opaque_front", "opaque_behind", "opaque_between"}, passes, "the depth test hides what is behind"},
               {{"glass", "leaves"}, passes, "it sorts the fragments of each pixel, not primitives"}}}},
    };
}

}  // namespace sheer::test
