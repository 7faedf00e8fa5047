#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace sheer {

/// A .glb or .gltf file taken apart; its first bytes say which it is.
struct GltfContainer {
    nlohmann::json document;                 ///< an object, of glTF 2.x, its lists no longer than is read
    std::optional<std::string_view> binary;  ///< the binary chunk of a .glb, within the bytes that were given
    bool is_binary = false;
    std::size_t bytes_after_end = 0;  ///< that a .glb has beyond the length in its header
};

/// Source: Khronos, glTF 2.0, section 4.4. A byte order mark is passed. Throws AssetError.
GltfContainer open_gltf(std::string_view bytes);

}  // namespace sheer
