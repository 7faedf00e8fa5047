// Rectangles parallel to the screen, each with its own depth, color and alpha: the scene whose picture can be worked
// out by hand. Of layers with equal depth, the one submitted later counts as nearer.
#include "renderer/scene/scene_info.h"

namespace sheer {

namespace {

constexpr std::size_t max_layers = 4096;

Geometry build_layers(const nlohmann::json& scene, const ImageSpec&, AssetReader&) {
    Geometry geometry;
    geometry.parallel = true;
    for (const auto& layer : scene.at("layers")) {
        const auto rect = layer.at("rect").get<std::vector<double>>();
        const auto color = layer.at("color").get<std::vector<float>>();
        const glm::vec4 tint(color[0], color[1], color[2], layer.at("alpha").get<float>());
        geometry.add_rect(rect[0], rect[1], rect[2], rect[3], layer.at("depth").get<float>(), tint,
                          layer.at("opaque").get<bool>());
    }
    return geometry;
}

Param depth_parameter() {
    Param depth = Param::number("depth", "0 is nearest", "", 0.5, 0, 1);
    depth.exclusive = true;
    return depth.required();
}

}  // namespace

SceneInfo scene_layers() {
    return {
        .id = "layers",
        .name = "Layers",
        .summary = "Rectangles of constant color and alpha at given depths; the picture can be worked out by hand.",
        .source = "Sheer",
        .parameters = {Param::list(
            "layers", "in submission order",
            {Param::numbers("rect", "two corners, origin top left, y down", "fraction of the image", {0, 0, 1, 1}, -4,
                            5)
                 .of({"x0", "y0", "x1", "y1"}),
             depth_parameter(), Param::color("color", "of the layer", {1, 1, 1}),
             Param::number("alpha", "opacity", "", 0.5, 0, 1),
             Param::boolean("opaque", "drawn without blending, with depth writes, before the transparent ones", false)},
            1, max_layers)},
        .build = build_layers,
        .transparent = "layers other than opaque ones",
    };
}

}  // namespace sheer
