#pragma once
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <vector>

namespace sheer::test {

/// The answer for a `layers` scene, worked out on the CPU in double precision from the spec alone: which layers cover
/// the middle of each pixel, what opaque ones hide, and the over operator from the background forward.
class Compositor {
  public:
    /// `black` is what is left of everything where no transmittance is.
    enum class Order { by_depth, by_submission, black };

    Compositor(const nlohmann::json& scene, int size_px, std::array<double, 3> background)
        : m_layers(scene.at("layers")), m_size_px(size_px), m_background(background) {}

    std::array<double, 3> pixel(int x, int y, Order order) const {
        if (order == Order::black) return {0, 0, 0};
        std::array<double, 3> color = m_background;
        double opaque_depth = 2;
        for (const auto& layer : m_layers) {
            // Of opaque layers at one depth the later submitted wins.
            if (layer.at("opaque") && covers(layer, x, y) && depth(layer) <= opaque_depth) {
                opaque_depth = depth(layer);
                color = layer.at("color").get<std::array<double, 3>>();
            }
        }
        std::vector<nlohmann::json> visible;
        for (const auto& layer : m_layers)
            if (!layer.at("opaque") && covers(layer, x, y) && depth(layer) <= opaque_depth) visible.push_back(layer);
        if (order == Order::by_depth)
            std::ranges::stable_sort(visible, [](const auto& a, const auto& b) { return depth(a) > depth(b); });
        for (const auto& layer : visible) {
            const double alpha = layer.at("alpha");
            for (int i = 0; i < 3; ++i)
                color[i] = alpha * layer.at("color").at(i).get<double>() + (1 - alpha) * color[i];
        }
        return color;
    }

  private:
    static float depth(const nlohmann::json& layer) { return layer.at("depth").get<float>(); }

    bool covers(const nlohmann::json& layer, int x, int y) const {
        const auto rect = layer.at("rect").get<std::array<double, 4>>();
        const double px = (x + 0.5) / m_size_px, py = (y + 0.5) / m_size_px;
        return px > rect[0] && px < rect[2] && py > rect[1] && py < rect[3];
    }

    nlohmann::json m_layers;
    int m_size_px;
    std::array<double, 3> m_background;
};

}  // namespace sheer::test
