#pragma once
#include <algorithm>

#include "renderer/litmus/scenes.h"
#include "tests/render/formulas.h"
#include "tests/render/render_test.h"

namespace sheer::test {

/// Its layers, with one method.
inline Spec litmus_spec(const LitmusScene& scene, const nlohmann::json& method, PixelFormat format) {
    return parse_spec({{"scene", {{"type", "layers"}, {"layers", scene.layers()}}},
                       {"methods", nlohmann::json::array({method})},
                       {"image",
                        {{"width", litmus_size_px},
                         {"height", litmus_size_px},
                         {"background", scene.background},
                         {"format", to_string(format)}}}});
}

/// Its rectangles, turned or not.
inline Geometry litmus_geometry(const LitmusScene& scene) {
    Geometry geometry;
    geometry.parallel = std::ranges::none_of(scene.surfaces, &LitmusSurface::is_turned);
    for (const LitmusSurface& surface : scene.surfaces) {
        const auto& [x0, y0, x1, y1] = surface.rect;
        const glm::vec4 tint(surface.color[0], surface.color[1], surface.color[2], surface.alpha);
        const std::size_t first = geometry.vertices.size();
        const auto left = static_cast<float>(surface.left_depth), right = static_cast<float>(surface.right_depth);
        geometry.add_rect(x0, y0, x1, y1, (left + right) / 2, tint, surface.opaque);
        const auto middle = static_cast<float>(x0 + x1 - 1);
        for (std::size_t i = first; i < geometry.vertices.size(); ++i) {
            Vertex& vertex = geometry.vertices[i];
            vertex.position.z = vertex.position.x < middle ? left : right;
        }
    }
    return geometry;
}

}  // namespace sheer::test
