#include "renderer/litmus/scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "renderer/core/random.h"

namespace sheer::litmus {

namespace {

LitmusSurface flat(double depth, const Color& color, double alpha, bool opaque = false,
                   const std::array<double, 4>& rect = {0, 0, 1, 1}) {
    return {rect, depth, depth, color, alpha, opaque};
}

/// Over the whole picture.
LitmusSurface turned(double left_depth, double right_depth, const Color& color, double alpha) {
    return {{0, 0, 1, 1}, left_depth, right_depth, color, alpha};
}

constexpr int orders = 6;

/// The same rectangles in any order.
LitmusScene shuffled_scene(int order) {
    Random random(11);
    LitmusScene scene;
    for (int i = 0; i < 8; ++i) {
        std::array<double, 4> at{};
        for (double& each : at) each = static_cast<double>(random.below(8)) / litmus_size_px;
        Color color{};
        for (double& each : color) each = random.unit();
        scene.surfaces.push_back(flat(0.1 + 0.1 * i, color, random.between(0.05, 1), false,
                                      {at[0], at[1], at[0] + 0.25 + at[2], at[1] + 0.25 + at[3]}));
    }
    Random shuffle(static_cast<std::uint64_t>(order));
    for (std::size_t i = scene.surfaces.size(); order > 0 && i > 1; --i)
        std::swap(scene.surfaces[i - 1], scene.surfaces[shuffle.below(i)]);
    return scene;
}

/// Three layers over black, white, or a checkerboard of squares of four pixels.
LitmusScene backdrop_scene(const std::string& id) {
    LitmusScene scene;
    scene.background = id == "white" ? Color{1, 1, 1} : Color{0, 0, 0};
    scene.surfaces = {flat(0.2, {0.2, 0.3, 0.9}, 0.5), flat(0.4, {0.1, 0.8, 0.3}, 0.5),
                      flat(0.6, {0.9, 0.2, 0.1}, 0.5)};
    if (id != "checker") return scene;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) {
            const double gray = (x + y) % 2;
            scene.surfaces.push_back(
                flat(0.9, {gray, gray, gray}, 1, true, {x / 4.0, y / 4.0, (x + 1) / 4.0, (y + 1) / 4.0}));
        }
    return scene;
}

/// Layers from near to far, in four columns with their own alpha.
LitmusScene column_scene(const std::array<double, 4>& alphas, const std::vector<Color>& colors) {
    LitmusScene scene;
    for (std::size_t column = 0; column < alphas.size(); ++column)
        for (std::size_t i = 0; i < colors.size(); ++i)
            scene.surfaces.push_back(
                flat(0.1 * static_cast<double>(i + 1), colors[i], alphas[column], false,
                     {static_cast<double>(column) / 4, 0, static_cast<double>(column + 1) / 4, 1}));
    return scene;
}

/// Two planes over the whole picture that intersect between two columns of pixels. Their middles are equally far, so a
/// sort takes the one submitted later as nearer.
LitmusScene crossing_scene(double alpha) {
    LitmusScene scene;
    scene.surfaces = {turned(0.2f, 0.8f, {0.2, 0.3, 0.9}, alpha), turned(0.8f, 0.2f, {0.9, 0.6, 0.1}, alpha)};
    return scene;
}

LitmusScene opaque_scene(double opaque_depth) {
    LitmusScene scene;
    scene.surfaces = {flat(0.3, {0.2, 0.3, 0.9}, 0.5), flat(0.7, {0.9, 0.1, 0.2}, 0.5),
                      flat(opaque_depth, {0.2, 0.8, 0.4}, 1, true)};
    return scene;
}

LitmusScene many_layers_scene() {
    LitmusScene scene;
    for (int i = 0; i < 64; ++i) {
        const Color color = i < 8 ? Color{0.9, 0.2, 0.1} : i < 32 ? Color{0.1, 0.3, 0.9} : Color{0.2, 0.8, 0.2};
        scene.surfaces.push_back(flat((i + 1) / 66.0, color, 1.0 / 16));
    }
    return scene;
}

/// Layers of different alphas: formulas that agree for equal ones differ.
LitmusScene unequal_scene() {
    LitmusScene scene;
    scene.surfaces = {flat(0.2, {0.2, 0.3, 0.9}, 0.2), flat(0.5, {0.9, 0.2, 0.1}, 0.7),
                      flat(0.8, {0.1, 0.9, 0.2}, 0.4)};
    return scene;
}

/// What is opaque but drawn as transparent, as leaves are, must hide what is behind it, also behind glass.
LitmusScene window_scene() {
    LitmusScene scene;
    scene.surfaces = {flat(0.2, {0.2, 0.3, 0.9}, 0.3), flat(0.5, {0.1, 0.8, 0.2}, 1), flat(0.8, {0.9, 0.2, 0.1}, 1)};
    return scene;
}

/// Two layers whose depths hardly differ, for methods that weigh depths or divide them into cells.
LitmusScene close_pair_scene() {
    LitmusScene scene;
    scene.surfaces = {flat(0.1, {0.9, 0.2, 0.1}, 0.6), flat(0.1 + 1.0 / 512, {0.1, 0.2, 0.9}, 0.6),
                      flat(0.9, {0.2, 0.9, 0.3}, 0.6)};
    return scene;
}

/// More layers than most methods keep, submitted neither from near to far nor from far to near.
LitmusScene interleaved_scene() {
    LitmusScene scene;
    for (int i = 0; i < 16; ++i) {
        const int layer = 7 * i % 16;
        scene.surfaces.push_back(flat((layer + 1) / 18.0, layer % 2 == 0 ? Color{1, 0.1, 0} : Color{0, 0.4, 1}, 0.3));
    }
    return scene;
}

/// Of one color, so that order and weights do not matter: only what cannot be summed does.
LitmusScene overflow_scene() {
    LitmusScene scene;
    scene.in_16_bits = true;
    for (int i = 0; i < 32; ++i) scene.surfaces.push_back(flat((i + 1) / 330.0, {0.9, 0.7, 0.2}, 0.96));
    return scene;
}

/// A hull that is turned, and a part within it that is nearer than the hull's middle, but behind the hull.
LitmusScene self_overlap_scene() {
    LitmusScene scene;
    scene.surfaces = {turned(0.2f, 0.8f, {0.2, 0.3, 0.9}, 0.4),
                      flat(0.45, {0.9, 0.2, 0.1}, 0.8, false, {0, 0, 0.25, 1})};
    return scene;
}

/// Three surfaces of an opaque model whose alpha falls: it must fade as a whole, without showing its inside.
LitmusScene fade_scene() {
    LitmusScene scene = column_scene({0.25, 0.5, 0.75, 1}, {{0.9, 0.5, 0.1}, {0.1, 0.3, 0.9}, {0.2, 0.9, 0.3}});
    scene.intended = [](const Stack& stack) {
        const double alpha = stack.fragments.front().alpha;
        return mix(stack.below, nearest_of(stack, 0, stack.below), alpha);
    };
    return scene;
}

LitmusScene make_scene(const std::string& id) {
    if (id.starts_with("shuffled_")) return shuffled_scene(std::stoi(id.substr(9)));
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
    if (id == "overflow") return overflow_scene();
    if (id == "self_overlap") return self_overlap_scene();
    if (id == "fade") return fade_scene();
    throw std::invalid_argument("there is no litmus scene " + id);
}

std::vector<std::string> shuffled_ids() {
    std::vector<std::string> ids;
    for (int order = 0; order < orders; ++order) ids.push_back(fmt::format("shuffled_{}", order));
    return ids;
}

std::vector<LitmusSceneInfo> make_infos() {
    std::vector<LitmusSceneInfo> all = {
        {"shuffled", "Shuffled",
         "Eight overlapping rectangles submitted in six orders. Passes: the same picture each time, correct or not.",
         shuffled_ids()},
        {"black", "Black", "Three full layers of alpha 0.5 over a black background.", {}},
        {"white", "White", "The same over a white background.", {}},
        {"checker", "Checker", "The same over an opaque black and white checkerboard.", {}},
        {"alpha_to_0",
         "Alpha to 0",
         "Six layers of alpha 1/128, 1/256, 1/512 and 0, from the left to the right of the picture.",
         {}},
        {"alpha_to_1",
         "Alpha to 1",
         "Four layers of alpha 127/128, 255/256, 511/512 and 1, from the left to the right of the picture.",
         {}},
        {"glass",
         "Crossing glass",
         "Two planes of alpha 0.5 that intersect: on the left one is nearer, on the right the other.",
         {}},
        {"leaves", "Crossing leaves", "The same planes with alpha 1, as leaves are within their outline.", {}},
        {"opaque_front", "Opaque in front", "An opaque plane in front of two layers of alpha 0.5.", {}},
        {"opaque_behind", "Opaque behind", "An opaque plane behind two layers of alpha 0.5.", {}},
        {"opaque_between", "Opaque between", "An opaque plane between two layers of alpha 0.5.", {}},
        {"one_layer",
         "One layer",
         "One layer of alpha 0.2, 0.4, 0.6 and 0.8, from the left to the right of the picture.",
         {}},
        {"64_layers",
         "64 layers",
         "64 layers of alpha 1/16: the nearest eight red, the next 24 blue, the rest green.",
         {}},
        {"unequal", "Unequal alphas", "Three layers of alpha 0.2, 0.7 and 0.4, from near to far.", {}},
        {"window",
         "Window",
         "Glass of alpha 0.3 in front of a leaf of alpha 1 that is drawn as transparent, in front of another leaf.",
         {}},
        {"close_pair",
         "Close pair",
         "Two layers of alpha 0.6 at the depths 0.1 and 0.1 + 1/512, and one of alpha 0.6 at 0.9.",
         {}},
        {"interleaved",
         "Interleaved",
         "Sixteen layers of alpha 0.3, alternately red and blue; the i-th that is submitted is number 7 i mod 16 in "
         "depth.",
         {}},
        {"overflow",
         "Overflow",
         "32 near layers of alpha 0.96, all of one color, drawn with `rgba16f`: what is summed with large weights "
         "exceeds the 65,504 of 16-bit floats.",
         {}},
        {"self_overlap",
         "Self-overlap",
         "A model's hull of alpha 0.4, at depths from 0.2 on the left to 0.8 on the right, and on the left a part "
         "within it, of alpha 0.8 at 0.45: behind the hull there, but nearer than its middle.",
         {}},
        {"fade",
         "Fade",
         "Three surfaces of an opaque model that fades out, at alpha 0.25, 0.5, 0.75 and 1 from the left to the right. "
         "Correct is the model's nearest surface at that alpha over the background: its inside must not show.",
         {}}};
    for (LitmusSceneInfo& info : all)
        if (info.scene_ids.empty()) info.scene_ids = {info.id};
    return all;
}

}  // namespace

nlohmann::json LitmusScene::layers(bool at_middles) const {
    nlohmann::json layers = nlohmann::json::array();
    for (const LitmusSurface& surface : surfaces) {
        const auto add = [&](const std::array<double, 4>& rect, double depth) {
            layers.push_back({{"rect", rect},
                              {"depth", depth},
                              {"color", surface.color},
                              {"alpha", surface.alpha},
                              {"opaque", surface.opaque}});
        };
        if (!surface.is_turned()) {
            add(surface.rect, surface.left_depth);
            continue;
        }
        for (int x = 0; x < litmus_size_px; ++x) {
            const double along = (x + 0.5) / litmus_size_px;
            add({static_cast<double>(x) / litmus_size_px, surface.rect[1], (x + 1.0) / litmus_size_px, surface.rect[3]},
                at_middles ? (surface.left_depth + surface.right_depth) / 2
                           : surface.left_depth + along * (surface.right_depth - surface.left_depth));
        }
    }
    return layers;
}

nlohmann::json LitmusScene::layers() const {
    return layers(false);
}

Compositor LitmusScene::compositor(bool at_middles) const {
    return {{{"layers", layers(at_middles)}}, litmus_size_px, background, in_16_bits};
}

Compositor LitmusScene::truth() const {
    return compositor(false);
}

Compositor LitmusScene::as_sorted() const {
    return compositor(true);
}

const std::vector<LitmusSceneInfo>& litmus_scene_infos() {
    static const std::vector<LitmusSceneInfo> all = make_infos();
    return all;
}

LitmusScene litmus_scene(const std::string& id) {
    LitmusScene scene = make_scene(id);
    scene.id = id;
    return scene;
}

std::vector<LitmusScene> all_litmus_scenes() {
    std::vector<LitmusScene> scenes;
    for (const LitmusSceneInfo& info : litmus_scene_infos())
        for (const std::string& id : info.scene_ids) scenes.push_back(litmus_scene(id));
    return scenes;
}

}  // namespace sheer::litmus
