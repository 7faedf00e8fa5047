#pragma once
#include <array>
#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

namespace sheer::test {

using Color = std::array<double, 3>;

struct Fragment {
    float depth;
    double alpha;
    Color color;
    std::size_t submitted = 0;  ///< place among the transparent layers
};

/// The contents of a pixel: the opaque picture, and the transparent fragments that it does not hide, as submitted.
struct Stack {
    Color below;
    std::vector<Fragment> fragments;
    std::size_t transparent_layers = 0;  ///< of the whole scene
};

/// A method's value of a pixel; not clamped.
using Formula = std::function<Color(const Stack& stack)>;

/// The contents of each pixel of a `layers` scene, computed on the CPU in double precision from the spec alone: which
/// layers cover its middle, and what opaque ones hide.
class Compositor {
  public:
    Compositor(const nlohmann::json& scene, int size_px, Color background)
        : m_size_px(size_px), m_background(background) {
        for (const auto& layer : scene.at("layers")) {
            m_layers.push_back({layer.at("rect").get<std::array<double, 4>>(), layer.at("depth").get<float>(),
                                layer.at("color").get<Color>(), layer.at("alpha").get<double>(),
                                layer.at("opaque").get<bool>()});
            m_transparent += m_layers.back().opaque ? 0 : 1;
        }
    }

    Stack stack(int x, int y) const {
        Stack stack{m_background, {}, m_transparent};
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

    Color pixel(int x, int y, const Formula& formula) const { return formula(stack(x, y)); }

  private:
    struct Layer {
        std::array<double, 4> rect;
        float depth;
        Color color;
        double alpha;
        bool opaque;
    };

    bool covers(const Layer& layer, int x, int y) const {
        const auto& rect = layer.rect;
        const double px = (x + 0.5) / m_size_px, py = (y + 0.5) / m_size_px;
        return px > rect[0] && px < rect[2] && py > rect[1] && py < rect[3];
    }

    std::vector<Layer> m_layers;
    int m_size_px;
    Color m_background;
    std::size_t m_transparent = 0;
};

}  // namespace sheer::test
