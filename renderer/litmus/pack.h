#pragma once
#include <string>
#include <vector>

#include "renderer/litmus/scenes.h"

namespace sheer::litmus {

/// The scene as JSON: its background, and its rectangles in the order of submission.
nlohmann::json scene_json(const LitmusScene& scene);

/// glTF 2.0, and the bytes of its only buffer, whose `uri` the document lacks.
struct GltfScene {
    nlohmann::json document;
    std::string bytes;
};

/// A mesh and a node for each rectangle, unlit, in the order of submission, and the camera to look through. glTF's
/// colors are linear.
GltfScene scene_gltf(const LitmusScene& scene);

/// What whoever renders the scenes must know.
std::string pack_readme();

}  // namespace sheer::litmus
