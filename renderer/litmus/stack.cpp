#include "renderer/litmus/stack.h"

namespace sheer::litmus {

Compositor::Compositor(const nlohmann::json& scene, int size_px, Color background, bool sums_in_16_bits)
    : m_size_px(size_px), m_background(background), m_sums_in_16_bits(sums_in_16_bits) {
    for (const auto& layer : scene.at("layers")) {
        m_layers.push_back({layer.at("rect").get<std::array<double, 4>>(), layer.at("depth").get<float>(),
                            layer.at("color").get<Color>(), layer.at("alpha").get<double>(),
                            layer.at("opaque").get<bool>()});
        m_transparent += m_layers.back().opaque ? 0 : 1;
    }
}

Stack Compositor::stack(int x, int y) const {
    Stack stack{m_background, {}, m_transparent, m_sums_in_16_bits};
    double opaque_depth = 2;
    for (const Layer& layer : m_layers) {
        // Of opaque layers at the same depth, the one submitted later wins.
        if (layer.opaque && covers(layer, x, y) && layer.depth <= opaque_depth) {
            opaque_depth = layer.depth;
            stack.below = layer.color;
        }
    }
    std::size_t submitted = 0;
    for (const Layer& layer : m_layers) {
        if (layer.opaque) continue;
        if (covers(layer, x, y) && layer.depth <= opaque_depth)
            stack.fragments.push_back({layer.depth, layer.alpha, layer.color, submitted});
        ++submitted;
    }
    return stack;
}

bool Compositor::covers(const Layer& layer, int x, int y) const {
    const auto& rect = layer.rect;
    const double px = (x + 0.5) / m_size_px, py = (y + 0.5) / m_size_px;
    return px > rect[0] && px < rect[2] && py > rect[1] && py < rect[3];
}

}  // namespace sheer::litmus
