#pragma once
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>

#include "renderer/scene/random.h"
#include "renderer/scene/scene_info.h"
#include "tests/render/compositor.h"

namespace sheer::test {

inline constexpr int litmus_size_px = 16;

/// A litmus scene as layers, whose edges lie on pixel corners. Two planes that cross are layers of one column of
/// pixels each, at the depth that the plane has in the middle of that column.
struct LitmusScene {
    nlohmann::json layers = nlohmann::json::array();  ///< as submitted
    Compositor::Color background = {0.1, 0.15, 0.05};
    std::optional<Geometry> planes;  ///< what is rendered in place of `layers`
    nlohmann::json sorted_layers;    ///< `layers` with the depths that a sort of primitives goes by; null: the same

    Spec spec(const nlohmann::json& method) const {
        return parse_spec({{"scene", {{"type", "layers"}, {"layers", layers}}},
                           {"methods", nlohmann::json::array({method})},
                           {"image",
                            {{"width", litmus_size_px},
                             {"height", litmus_size_px},
                             {"background", background},
                             {"format", "rgba32f"}}}});
    }
    Geometry geometry(const Spec& spec) const {
        if (planes) return *planes;
        NoAssets assets;
        return build_geometry(spec.scene, spec.image, assets);
    }
    Compositor truth() const { return compositor(layers); }
    Compositor as_sorted() const { return compositor(sorted_layers.is_null() ? layers : sorted_layers); }

  private:
    Compositor compositor(const nlohmann::json& of) const { return {{{"layers", of}}, litmus_size_px, background}; }
};

inline nlohmann::json litmus_layer(double depth, const Compositor::Color& color, double alpha, bool opaque = false,
                                   const std::array<double, 4>& rect = {0, 0, 1, 1}) {
    return {{"rect", rect}, {"depth", depth}, {"color", color}, {"alpha", alpha}, {"opaque", opaque}};
}

/// The same rectangles whatever the order.
inline LitmusScene shuffled_scene(std::uint64_t order) {
    Random random(11);
    std::vector<nlohmann::json> layers;
    for (int i = 0; i < 8; ++i) {
        std::array<double, 4> at{};
        for (double& each : at) each = static_cast<double>(random.below(8)) / litmus_size_px;
        Compositor::Color color{};
        for (double& each : color) each = random.unit();
        layers.push_back(litmus_layer(0.1 + 0.1 * i, color, random.between(0.05, 1), false,
                                      {at[0], at[1], at[0] + 0.25 + at[2], at[1] + 0.25 + at[3]}));
    }
    Random shuffle(order);
    for (std::size_t i = layers.size(); order > 0 && i > 1; --i) std::swap(layers[i - 1], layers[shuffle.below(i)]);
    LitmusScene scene;
    scene.layers = layers;
    return scene;
}

/// Three layers over black, white, or a checkerboard of squares of four pixels.
inline LitmusScene backdrop_scene(const std::string& id) {
    LitmusScene scene;
    scene.background = id == "white" ? Compositor::Color{1, 1, 1} : Compositor::Color{0, 0, 0};
    scene.layers = {litmus_layer(0.2, {0.2, 0.3, 0.9}, 0.5), litmus_layer(0.4, {0.1, 0.8, 0.3}, 0.5),
                    litmus_layer(0.6, {0.9, 0.2, 0.1}, 0.5)};
    if (id != "checker") return scene;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) {
            const double gray = (x + y) % 2;
            scene.layers.push_back(
                litmus_layer(0.9, {gray, gray, gray}, 1, true, {x / 4.0, y / 4.0, (x + 1) / 4.0, (y + 1) / 4.0}));
        }
    return scene;
}

/// In four columns with their own alpha, layers from near to far.
inline LitmusScene column_scene(const std::array<double, 4>& alphas, const std::vector<Compositor::Color>& colors) {
    LitmusScene scene;
    for (std::size_t column = 0; column < alphas.size(); ++column)
        for (std::size_t i = 0; i < colors.size(); ++i)
            scene.layers.push_back(
                litmus_layer(0.1 * static_cast<double>(i + 1), colors[i], alphas[column], false,
                             {static_cast<double>(column) / 4, 0, static_cast<double>(column + 1) / 4, 1}));
    return scene;
}

/// Two planes over the whole picture, one going back from the left to the right, one coming forward; they cut each
/// other between two columns of pixels. Their middles are equally far, so a sort takes the later submitted for the
/// nearer.
inline LitmusScene crossing_scene(double alpha) {
    const std::array<std::array<float, 2>, 2> depths = {{{0.2f, 0.8f}, {0.8f, 0.2f}}};  // left and right
    const std::array<Compositor::Color, 2> colors = {{{0.2, 0.3, 0.9}, {0.9, 0.6, 0.1}}};
    LitmusScene scene;
    scene.planes.emplace();
    scene.sorted_layers = nlohmann::json::array();
    for (std::size_t i = 0; i < 2; ++i) {
        const auto [left, right] = depths[i];
        const glm::vec4 tint(colors[i][0], colors[i][1], colors[i][2], alpha);
        scene.planes->add_rect(0, 0, 1, 1, (left + right) / 2, tint, false);
        for (std::size_t corner = 0; corner < 4; ++corner) {
            Vertex& vertex = scene.planes->vertices[4 * i + corner];
            vertex.position.z = vertex.position.x < 0 ? left : right;
        }
        for (int x = 0; x < litmus_size_px; ++x) {
            const double along = (x + 0.5) / litmus_size_px;
            nlohmann::json layer =
                litmus_layer(left + along * (right - left), colors[i], alpha, false,
                             {static_cast<double>(x) / litmus_size_px, 0, (x + 1.0) / litmus_size_px, 1});
            scene.layers.push_back(layer);
            layer["depth"] = (left + right) / 2;
            scene.sorted_layers.push_back(layer);
        }
    }
    return scene;
}

inline LitmusScene opaque_scene(double opaque_depth) {
    LitmusScene scene;
    scene.layers = {litmus_layer(0.3, {0.2, 0.3, 0.9}, 0.5), litmus_layer(0.7, {0.9, 0.1, 0.2}, 0.5),
                    litmus_layer(opaque_depth, {0.2, 0.8, 0.4}, 1, true)};
    return scene;
}

inline LitmusScene many_layers_scene() {
    LitmusScene scene;
    for (int i = 0; i < 64; ++i) {
        const Compositor::Color color = i < 8    ? Compositor::Color{0.9, 0.2, 0.1}
                                        : i < 32 ? Compositor::Color{0.1, 0.3, 0.9}
                                                 : Compositor::Color{0.2, 0.8, 0.2};
        scene.layers.push_back(litmus_layer((i + 1) / 66.0, color, 1.0 / 16));
    }
    return scene;
}

/// By its id in litmus.json; `shuffled` is one of several, see above.
inline LitmusScene litmus_scene(const std::string& id) {
    if (id == "black" || id == "white" || id == "checker") return backdrop_scene(id);
    if (id == "alpha_to_0") {
        const Compositor::Color light = {1, 1, 1}, lighter = {0.9, 0.8, 0.9};
        return column_scene({1.0 / 128, 1.0 / 256, 1.0 / 512, 0}, {light, lighter, light, lighter, light, lighter});
    }
    if (id == "alpha_to_1")
        return column_scene({127.0 / 128, 255.0 / 256, 511.0 / 512, 1},
                            {{0.4, 0.7, 0.2}, {0.3, 0.4, 0.1}, {0.2, 0.2, 0.3}, {0.2, 0.1, 0.1}});
    if (id == "one_layer") return column_scene({0.2, 0.4, 0.6, 0.8}, {{0.9, 0.8, 0.7}});
    if (id == "glass") return crossing_scene(0.5);
    if (id == "leaves") return crossing_scene(1);
    if (id == "opaque_front") return opaque_scene(0.1);
    if (id == "opaque_between") return opaque_scene(0.5);
    if (id == "opaque_behind") return opaque_scene(0.9);
    if (id == "64_layers") return many_layers_scene();
    throw std::invalid_argument("there is no litmus scene " + id);
}

}  // namespace sheer::test
