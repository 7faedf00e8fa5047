// A white layer over the whole picture.
#include "renderer/scene/scene_info.h"

namespace sheer {
namespace {

Geometry build_made_up_scene(const nlohmann::json& scene, const ImageSpec&, AssetReader&) {
    Geometry geometry;
    geometry.parallel = true;
    geometry.add_rect(0, 0, 1, 1, 0.5f, glm::vec4(1, 1, 1, scene.at("veil").get<float>()), false);
    return geometry;
}

}  // namespace

SceneInfo scene_made_up_scene() {
    return {
        .id = "made_up_scene",
        .name = "Made-up scene",
        .summary = "A white layer over the whole picture.",
        .source = "Made up",
        .parameters = {Param::number("veil", "opacity of the layer", "", 0.4, 0, 1)},
        .build = build_made_up_scene,
    };
}

}  // namespace sheer
