#pragma once
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "renderer/assets/gltf_file.h"

namespace sheer {

/// A mesh where a node, or an instance of one, puts it.
struct GltfPlacement {
    std::uint64_t mesh;
    std::string what;  ///< the node
    glm::dmat4 world;
};

/// Every use of a mesh in the default scene, else the first one, in the order of the file, parents first.
///
/// A skinned mesh stands where its file has it, whatever its node's transform (glTF 2.0, section 3.7.3.3); instances
/// are those of EXT_mesh_gpu_instancing; what KHR_node_visibility hides is left out. Throws AssetError, also where
/// nodes form no trees.
std::vector<GltfPlacement> place_meshes(GltfFile& file);

}  // namespace sheer
