#include "renderer/litmus/formula.h"

#include <algorithm>
#include <ranges>

namespace sheer::litmus {

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

}  // namespace

FormulaInfo formula_mlab() {
    return {.id = "mlab",
            .name = "multi-layer alpha blending",
            .make = [](const nlohmann::json& parameters) -> Formula {
                return
                    [=](const Stack& stack) { return merged_nodes(stack, parameters.value("nodes", std::size_t{4})); };
            },
            .depends_on_order = true,
            .variants = {{{"nodes", 2}}, {{"nodes", 3}}, {{"nodes", 4}}, {{"nodes", 6}}}};
}

}  // namespace sheer::litmus
