#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace sheer {

/// The parts of a .glb or .gltf file; its first bytes show which it is.
struct GltfContainer {
    nlohmann::json document;                 ///< an object, of glTF 2.x, whose lists are within the limit
    std::optional<std::string_view> binary;  ///< the binary chunk of a .glb, within the given bytes
    bool is_binary = false;
    std::size_t bytes_after_end = 0;  ///< of a .glb, beyond the length in its header
};

/// Source: Khronos, glTF 2.0, section 4.4. A byte order mark is skipped. Throws AssetError.
GltfContainer open_gltf(std::string_view bytes);

}  // namespace sheer
