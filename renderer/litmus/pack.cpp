#include "renderer/litmus/pack.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "renderer/litmus/drawing.h"

namespace sheer::litmus {

namespace {

using nlohmann::json;

constexpr int float_component = 5126, array_buffer = 34962, triangle_strip = 5;

/// The corners in normalised device coordinates, as a strip of two triangles; z is minus the depth.
std::array<float, 12> corners_of(const LitmusSurface& surface) {
    const auto& [x0, y0, x1, y1] = surface.rect;
    const auto left = static_cast<float>(2 * x0 - 1), right = static_cast<float>(2 * x1 - 1);
    const auto top = static_cast<float>(1 - 2 * y0), bottom = static_cast<float>(1 - 2 * y1);
    const auto left_z = static_cast<float>(-surface.left_depth), right_z = static_cast<float>(-surface.right_depth);
    return {left, bottom, left_z, right, bottom, right_z, left, top, left_z, right, top, right_z};
}

json position_accessor(std::size_t view, const std::array<float, 12>& corners) {
    json least = json::array(), most = json::array();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        float low = corners[axis], high = corners[axis];
        for (std::size_t i = axis; i < corners.size(); i += 3) {
            low = std::min(low, corners[i]);
            high = std::max(high, corners[i]);
        }
        least.push_back(low);
        most.push_back(high);
    }
    return {{"bufferView", view}, {"componentType", float_component}, {"count", 4}, {"type", "VEC3"}, {"min", least},
            {"max", most}};
}

json material_of(const LitmusSurface& surface) {
    json factor = json::array();
    for (const double channel : surface.color) factor.push_back(srgb_to_linear(channel));
    factor.push_back(surface.alpha);
    return {{"pbrMetallicRoughness", {{"baseColorFactor", factor}, {"metallicFactor", 0}, {"roughnessFactor", 1}}},
            {"alphaMode", surface.opaque ? "OPAQUE" : "BLEND"},
            {"doubleSided", true},
            {"extensions", {{"KHR_materials_unlit", json::object()}}}};
}

constexpr const char* readme_head = R"(# Litmus scenes

Small scenes whose correct pictures are known, to find out which formula a renderer blends with. Made by `sheer litmus export`.

| folder | what |
|---|---|
| `scenes/ID.json` | the scene as rectangles |
| `scenes/ID.gltf` | the same as glTF 2.0 with its data within |
| `expected/ID.png`, `expected/ID.exr` | the correct picture if sRGB-encoded values are blended, as most programs do |
| `expected-linear/ID.png`, `expected-linear/ID.exr` | the correct picture if linear values are blended and then sRGB-encoded |

1. Render each scene into a picture of 16 x 16 pixels, or of a multiple, each pixel then as one square.
2. Save it as `ID.png` (8 or 16 bits) or `ID.exr` (floats), without an alpha channel or with one that is not to be applied.
3. `sheer litmus identify FOLDER` names the formula.

A scene that cannot be rendered may be left out; fewer scenes tell fewer formulas apart.

## What the numbers mean
- `rect`: left, top, right and bottom in fractions of the picture; the origin is at the top left. All edges are on pixel corners
  of 16 x 16 pixels.
- `left_depth`, `right_depth`: the depth at the left and right edge; 0 is nearest, 1 farthest, linear. In glTF z is minus the depth,
  x and y are -1 to 1, and the camera is orthographic, so that a depth buffer has just these depths.
- `color`: sRGB-encoded, as in a picture, and not multiplied by alpha. In glTF, whose colors are linear, it is converted.
- `alpha`: 0 to 1. `opaque`: drawn first, without blending, with depth writes.
- `background`: sRGB-encoded, opaque. glTF has no background: it is in `extras.background`.
- The rectangles are in the order in which they are to be submitted. A renderer that sorts may sort them.
- Nothing is lit: the color is the color.
- The scene `fade` is to fade as one object; a renderer that blends surfaces one by one shows its inside, so that no formula gives
  the expected picture.
- The scene `overflow` is meant for sums in 16-bit floats.

## Scenes
| id | what it is |
|---|---|
)";

}  // namespace

json scene_json(const LitmusScene& scene) {
    json surfaces = json::array();
    for (const LitmusSurface& surface : scene.surfaces)
        surfaces.push_back({{"rect", surface.rect},
                            {"left_depth", surface.left_depth},
                            {"right_depth", surface.right_depth},
                            {"color", surface.color},
                            {"alpha", surface.alpha},
                            {"opaque", surface.opaque}});
    return {{"id", scene.id}, {"size_px", litmus_size_px}, {"background", scene.background}, {"surfaces", surfaces}};
}

GltfScene scene_gltf(const LitmusScene& scene) {
    static_assert(std::endian::native == std::endian::little, "glTF's data is little-endian");
    json meshes = json::array(), nodes = json::array(), views = json::array(), accessors = json::array(),
         materials = json::array(), roots = json::array();
    std::string bytes;
    for (const LitmusSurface& surface : scene.surfaces) {
        const std::array<float, 12> corners = corners_of(surface);
        const std::size_t index = meshes.size();
        views.push_back(
            {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", sizeof corners}, {"target", array_buffer}});
        bytes.append(reinterpret_cast<const char*>(corners.data()), sizeof corners);
        accessors.push_back(position_accessor(index, corners));
        materials.push_back(material_of(surface));
        meshes.push_back(
            {{"primitives", {{{"attributes", {{"POSITION", index}}}, {"material", index}, {"mode", triangle_strip}}}}});
        nodes.push_back({{"name", fmt::format("surface {}", index)}, {"mesh", index}});
        roots.push_back(index);
    }
    roots.push_back(nodes.size());
    nodes.push_back({{"name", "camera"}, {"camera", 0}});
    const json document = {
        {"asset", {{"version", "2.0"}, {"generator", "sheer litmus export"}}},
        {"extensionsUsed", {"KHR_materials_unlit"}},
        {"extras", {{"background", scene.background}}},
        {"scene", 0},
        {"scenes", {{{"nodes", roots}}}},
        {"nodes", nodes},
        {"cameras",
         {{{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0}, {"zfar", 1}}}}}},
        {"meshes", meshes},
        {"materials", materials},
        {"accessors", accessors},
        {"bufferViews", views},
        {"buffers", {{{"byteLength", bytes.size()}}}}};
    return {document, bytes};
}

std::string pack_readme() {
    std::string text = readme_head;
    for (const LitmusSceneInfo& info : litmus_scene_infos()) {
        const std::string ids = info.scene_ids.size() == 1
                                    ? fmt::format("`{}`", info.scene_ids.front())
                                    : fmt::format("`{}` to `{}`", info.scene_ids.front(), info.scene_ids.back());
        text += fmt::format("| {} | {} |\n", ids, info.what);
    }
    return text;
}

}  // namespace sheer::litmus
