#pragma once
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "renderer/assets/gltf_file.h"

namespace sheer {

/// A mesh as a node, or an instance of one, places it.
struct GltfPlacement {
    std::uint64_t mesh;
    std::string what;  ///< the node
    glm::dmat4 world;
};

/// Every use of a mesh in the default scene, or in the first one if there is none, in the order of the file, parents
/// first.
///
/// A skinned mesh is placed as it is stored, whatever its node's transform (glTF 2.0, section 3.7.3.3); instances are
/// those of EXT_mesh_gpu_instancing; nodes that KHR_node_visibility hides are left out. Throws AssetError, also if the
/// nodes do not form trees.
std::vector<GltfPlacement> place_meshes(GltfFile& file);

}  // namespace sheer
