#pragma once
#include <string>
#include <string_view>

#include "renderer/assets/gltf_object.h"

namespace sheer {

/// The bytes of a buffer view with EXT_meshopt_compression: `extension` says how to read `compressed`.
/// Source: Khronos, EXT_meshopt_compression; meshoptimizer. Throws AssetError.
std::string decode_meshopt(const GltfObject& extension, std::string_view compressed);

}  // namespace sheer
