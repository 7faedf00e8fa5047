#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace sheer {

/// Triangles as in KHR_draco_mesh_compression.
struct DracoMesh {
    /// Values of every vertex, one after another, little-endian.
    struct Attribute {
        std::shared_ptr<const std::string> data;
        int components = 0;
        std::uint64_t component_type = 0;  ///< as for accessors
    };
    std::size_t vertex_count = 0;
    std::vector<std::uint32_t> corners;             ///< three for each triangle; each is a valid vertex index
    std::map<std::uint64_t, Attribute> attributes;  ///< by their unique ids
};

/// Decodes the attributes with these ids. `what` names the primitive in errors.
/// Source: Google, Draco bitstream 2.2; Khronos, KHR_draco_mesh_compression. Throws AssetError.
DracoMesh decode_draco(std::string_view bytes, const std::vector<std::uint64_t>& ids, const std::string& what);

}  // namespace sheer
