#pragma once
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "renderer/core/random.h"
#include "renderer/scene/scene_info.h"
#include "renderer/spec/spec.h"
#include "tests/render/compositor.h"

namespace sheer::test {

inline constexpr int litmus_size_px = 16;

/// A litmus scene as layers, whose edges are on pixel corners. Two planes that cross are represented by layers of one
/// column of pixels each, at the plane's depth in the middle of that column.
struct LitmusScene {
    nlohmann::json layers = nlohmann::json::array();  ///< as submitted
    Color background = {0.1, 0.15, 0.05};
    std::optional<Geometry> planes;  ///< what is rendered instead of `layers`
    nlohmann::json sorted_layers;    ///< `layers` with the depths by which primitives are sorted; null: the same

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

inline nlohmann::json litmus_layer(double depth, const Color& color, double alpha, bool opaque = false,
                                   const std::array<double, 4>& rect = {0, 0, 1, 1}) {
    return {{"rect", rect}, {"depth", depth}, {"color", color}, {"alpha", alpha}, {"opaque", opaque}};
}

/// The same rectangles in any order.
inline LitmusScene shuffled_scene(std::uint64_t order) {
    Random random(11);
    std::vector<nlohmann::json> layers;
    for (int i = 0; i < 8; ++i) {
        std::array<double, 4> at{};
        for (double& each : at) each = static_cast<double>(random.below(8)) / litmus_size_px;
        Color color{};
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
    scene.background = id == "white" ? Color{1, 1, 1} : Color{0, 0, 0};
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

/// Layers from near to far, in four columns with their own alpha.
inline LitmusScene column_scene(const std::array<double, 4>& alphas, const std::vector<Color>& colors) {
    LitmusScene scene;
    for (std::size_t column = 0; column < alphas.size(); ++column)
        for (std::size_t i = 0; i < colors.size(); ++i)
            scene.layers.push_back(
                litmus_layer(0.1 * static_cast<double>(i + 1), colors[i], alphas[column], false,
                             {static_cast<double>(column) / 4, 0, static_cast<double>(column + 1) / 4, 1}));
    return scene;
}

/// Two planes over the whole picture; from left to right, one recedes and the other approaches. They intersect between
/// two columns of pixels. Their middles are equally far, so a sort takes the one submitted later as nearer.
inline LitmusScene crossing_scene(double alpha) {
    const std::array<std::array<float, 2>, 2> depths = {{{0.2f, 0.8f}, {0.8f, 0.2f}}};  // left and right
    const std::array<Color, 2> colors = {{{0.2, 0.3, 0.9}, {0.9, 0.6, 0.1}}};
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
        const Color color = i < 8 ? Color{0.9, 0.2, 0.1} : i < 32 ? Color{0.1, 0.3, 0.9} : Color{0.2, 0.8, 0.2};
        scene.layers.push_back(litmus_layer((i + 1) / 66.0, color, 1.0 / 16));
    }
    return scene;
}

/// Layers of different alphas: formulas that agree for equal ones differ.
inline LitmusScene unequal_scene() {
    LitmusScene scene;
    scene.layers = {litmus_layer(0.2, {0.2, 0.3, 0.9}, 0.2), litmus_layer(0.5, {0.9, 0.2, 0.1}, 0.7),
                    litmus_layer(0.8, {0.1, 0.9, 0.2}, 0.4)};
    return scene;
}

/// What is opaque but drawn as transparent, as leaves are, must hide what is behind it, also behind glass.
inline LitmusScene window_scene() {
    LitmusScene scene;
    scene.layers = {litmus_layer(0.2, {0.2, 0.3, 0.9}, 0.3), litmus_layer(0.5, {0.1, 0.8, 0.2}, 1),
                    litmus_layer(0.8, {0.9, 0.2, 0.1}, 1)};
    return scene;
}

/// Two layers whose depths hardly differ, for methods that weigh depths or divide them into cells.
inline LitmusScene close_pair_scene() {
    LitmusScene scene;
    scene.layers = {litmus_layer(0.1, {0.9, 0.2, 0.1}, 0.6), litmus_layer(0.1 + 1.0 / 512, {0.1, 0.2, 0.9}, 0.6),
                    litmus_layer(0.9, {0.2, 0.9, 0.3}, 0.6)};
    return scene;
}

/// More layers than most methods keep, submitted neither from near to far nor from far to near.
inline LitmusScene interleaved_scene() {
    LitmusScene scene;
    for (int i = 0; i < 16; ++i) {
        const int layer = 7 * i % 16;
        scene.layers.push_back(
            litmus_layer((layer + 1) / 18.0, layer % 2 == 0 ? Color{1, 0.1, 0} : Color{0, 0.4, 1}, 0.3));
    }
    return scene;
}

/// What docs/litmus.md says about a scene.
struct LitmusSceneInfo {
    std::string id, name, what;
};

inline const std::vector<LitmusSceneInfo>& litmus_scene_infos() {
    static const std::vector<LitmusSceneInfo> all = {
        {"shuffled", "Shuffled",
         "Eight overlapping rectangles submitted in six orders. Passes: the same picture each time, correct or not."},
        {"black", "Black", "Three full layers of alpha 0.5 over a black background."},
        {"white", "White", "The same over a white background."},
        {"checker", "Checker", "The same over an opaque black and white checkerboard."},
        {"alpha_to_0", "Alpha to 0",
         "Six layers of alpha 1/128, 1/256, 1/512 and 0, from the left to the right of the picture."},
        {"alpha_to_1", "Alpha to 1",
         "Four layers of alpha 127/128, 255/256, 511/512 and 1, from the left to the right of the picture."},
        {"glass", "Crossing glass",
         "Two planes of alpha 0.5 that intersect: on the left one is nearer, on the right the other."},
        {"leaves", "Crossing leaves", "The same planes with alpha 1, as leaves are within their outline."},
        {"opaque_front", "Opaque in front", "An opaque plane in front of two layers of alpha 0.5."},
        {"opaque_behind", "Opaque behind", "An opaque plane behind two layers of alpha 0.5."},
        {"opaque_between", "Opaque between", "An opaque plane between two layers of alpha 0.5."},
        {"one_layer", "One layer",
         "One layer of alpha 0.2, 0.4, 0.6 and 0.8, from the left to the right of the picture."},
        {"64_layers", "64 layers", "64 layers of alpha 1/16: the nearest eight red, the next 24 blue, the rest green."},
        {"unequal", "Unequal alphas", "Three layers of alpha 0.2, 0.7 and 0.4, from near to far."},
        {"window", "Window",
         "Glass of alpha 0.3 in front of a leaf of alpha 1 that is drawn as transparent, in front of another leaf."},
        {"close_pair", "Close pair",
         "Two layers of alpha 0.6 at the depths 0.1 and 0.1 + 1/512, and one of alpha 0.6 at 0.9."},
        {"interleaved", "Interleaved",
         "Sixteen layers of alpha 0.3, alternately red and blue; the i-th that is submitted is number 7 i mod 16 in "
         "depth."}};
    return all;
}

/// By its id; `shuffled` is one of several, see above.
inline LitmusScene litmus_scene(const std::string& id) {
    if (id == "black" || id == "white" || id == "checker") return backdrop_scene(id);
    if (id == "alpha_to_0") {
        const Color light = {1, 1, 1}, lighter = {0.9, 0.8, 0.9};
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
    if (id == "unequal") return unequal_scene();
    if (id == "window") return window_scene();
    if (id == "close_pair") return close_pair_scene();
    if (id == "interleaved") return interleaved_scene();
    throw std::invalid_argument("there is no litmus scene " + id);
}

}  // namespace sheer::test
