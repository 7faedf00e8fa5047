#pragma once
#include <functional>
#include <string>
#include <string_view>

#include "renderer/assets/gltf_library.h"
#include "renderer/scene/assets.h"

namespace sheer {

/// Gives the bytes of another file that a model names (percent signs decoded). Throws AssetError where it may not.
using OtherFiles = std::function<std::string(const std::string& name)>;

/// For a model that stands alone: throws AssetError for every name.
std::string no_other_files(const std::string& name);

/// A .glb or .gltf file with the bytes of its buffers; its first bytes say which it is.
///
/// tinygltf believes some of what a file says of itself and passes over what it does not understand. So the container,
/// the depth of the JSON, buffers, buffer views and the places of pictures are checked before; what tinygltf then
/// reports is an error, too. Indices between the objects and the accessors are for the caller to check.
/// Source: Khronos, glTF 2.0, sections 3.6 and 4.4.
/// Throws AssetError.
tinygltf::Model read_gltf_file(std::string_view bytes, const OtherFiles& others);

/// The encoded picture of an image of such a model. Throws AssetError.
std::string read_gltf_picture(const tinygltf::Model& gltf, const tinygltf::Image& image, const OtherFiles& others);

}  // namespace sheer
