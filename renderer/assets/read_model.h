#pragma once
#include <cstddef>
#include <filesystem>
#include <string_view>

#include "renderer/assets/gltf_file.h"
#include "renderer/scene/model.h"

namespace sheer {

inline constexpr std::size_t max_model_triangles = 4000000, max_model_vertices = 12000000;

/// The triangles of a glTF 2.0 file, .glb or .gltf: the default scene, or the first one if there is none, with the
/// nodes' transforms. docs/models.md lists what is read, what becomes a note and what is refused. Positions are
/// computed in double precision and stored relative to the middle of the model.
///
/// Throws AssetError with the reason for anything that violates glTF, is not finite or is over a limit.
Model read_model(std::string_view bytes, const OtherFiles& others);

/// For a model on this machine: files in `folder` or below it. Throws AssetError for any other.
OtherFiles files_below(const std::filesystem::path& folder);

}  // namespace sheer
