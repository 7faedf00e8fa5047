#include "tests/render/method_row.h"

#include <algorithm>
#include <ranges>

namespace sheer::test {

namespace {

struct Node {
    double depth;
    Color premultiplied;
    double transmittance;
};

/// In the order of submission. Of equal depths, the one submitted later is in front.
Color merged_nodes(const Stack& stack, std::size_t most) {
    std::vector<Node> nodes;
    for (const Fragment& fragment : stack.fragments) {
        if (fragment.alpha == 0) continue;
        Color premultiplied = fragment.color;
        for (double& channel : premultiplied) channel *= fragment.alpha;
        const auto place = std::ranges::find_if(nodes, [&](const Node& node) { return node.depth >= fragment.depth; });
        nodes.insert(place, {fragment.depth, premultiplied, 1 - fragment.alpha});
        if (nodes.size() <= most) continue;
        Node& last = nodes[most - 1];
        for (std::size_t i = 0; i < 3; ++i) last.premultiplied[i] += last.transmittance * nodes[most].premultiplied[i];
        last.transmittance *= nodes[most].transmittance;
        nodes.pop_back();
    }
    Color color = stack.below;
    for (const Node& node : std::ranges::reverse_view(nodes))
        for (std::size_t i = 0; i < 3; ++i) color[i] = node.premultiplied[i] + node.transmittance * color[i];
    return color;
}

/// With 16-bit nodes each insertion may round each of the nodes it goes through.
double nodes_bound(const Stack& stack, PixelFormat format) {
    if (format == PixelFormat::rgba32f) return rounded_once(stack, format);
    return std::min(1.0, 2 * static_cast<double>(stack.fragments.size() + 4) * 0x1p-10) + step_of(format);
}

}  // namespace

MethodRow row_mlab() {
    return {
        .id = "mlab",
        .formula = [](const nlohmann::json& parameters) -> Formula {
            return [=](const Stack& stack) { return merged_nodes(stack, parameters.value("nodes", std::size_t{4})); };
        },
        .variants = {{nlohmann::json::object(), nodes_bound},
                     {{{"nodes", 2}}, nodes_bound},
                     {{{"nodes", 3}}, nodes_bound},
                     {{{"nodes", 5}}, nodes_bound},
                     {{{"nodes", 6}}, nodes_bound}},
        .litmus =
            {{"",
              {nlohmann::json::object()},
              {{{"shuffled"}, fails, "where more than four layers overlap, one may come between two that were merged"},
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
