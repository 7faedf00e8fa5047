#pragma once
#include <cstddef>
#include <filesystem>
#include <string_view>

#include "renderer/assets/gltf_file.h"
#include "renderer/scene/model.h"

namespace sheer {

inline constexpr std::size_t max_model_triangles = 4000000, max_model_vertices = 12000000;

/// The triangles of a glTF 2.0 file, .glb or .gltf: the default scene, else the first one, with the nodes' transforms.
///
/// Read are positions, normals (where there are none, those of the triangles), the texture coordinates of the base
/// colour, COLOR_0, alphaMode, alphaCutoff, baseColorFactor and the base colour's texture. Strips and fans become
/// triangles; points and lines are passed over, as are skins, morph targets, animations, cameras and lights. Pictures
/// are scaled to one size of powers of two, as large as the largest of them, at most 2048 px a side and 16 million
/// pixels in all. Linear factors are sRGB-encoded, see renderer/scene/model.h.
///
/// Throws AssetError with the reason for anything that is not as glTF says, is not finite or is over a limit.
Model read_model(std::string_view bytes, const OtherFiles& others);

/// For a model on this machine: files in `folder` or below it. Throws AssetError for any other.
OtherFiles files_below(const std::filesystem::path& folder);

}  // namespace sheer
