#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "renderer/assets/gltf_accessor.h"
#include "renderer/assets/gltf_draco.h"
#include "renderer/assets/gltf_file.h"

namespace sheer {

/// Triangles of one material in a mesh, stored in accessors or compressed by Draco. The file outlives it.
/// All functions throw AssetError.
class GltfPrimitive {
  public:
    GltfPrimitive(GltfFile& file, const GltfObject& object);

    const std::string& what() const { return m_object.what(); }
    const GltfObject& object() const { return m_object; }
    /// False for points and lines.
    bool is_triangles() const { return m_mode >= mode_triangles; }

    bool has(const std::string& attribute) const;
    /// With as many elements as there are positions; nothing if the primitive does not have it.
    std::optional<GltfAccessor> attribute(const std::string& name, int least_components, int most_components) const;
    GltfAccessor positions() const;

    /// Vertices that already take memory, because they were compressed.
    std::size_t decoded_vertices() const { return m_draco ? m_draco->vertex_count : 0; }

    /// How many triangles there are, without allocating memory for them.
    std::size_t triangle_count() const;
    /// Indices of vertices, three for each triangle, each within the positions. (glTF 2.0, section 3.7.2.1.)
    std::vector<std::uint32_t> corners() const;

  private:
    static constexpr std::uint64_t mode_triangles = 4, mode_strip = 5, mode_fan = 6;

    void decode(const GltfObject& draco);
    GltfAccessor find(const std::string& name) const;
    std::optional<GltfAccessor> indices() const;

    GltfFile& m_file;
    GltfObject m_object;
    std::uint64_t m_mode;
    std::optional<GltfObject> m_attributes;
    std::optional<DracoMesh> m_draco;
    std::optional<GltfObject> m_draco_ids;
};

}  // namespace sheer
