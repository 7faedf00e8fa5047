#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

#include "renderer/assets/gltf_library.h"

namespace sheer {

/// The numbers of an accessor, which all lie within its buffer. The model outlives it.
class GltfAccessor {
  public:
    /// Of `gltf`, which read_gltf_file gave. `what` names it in errors, such as "mesh 0, primitive 1: POSITION".
    /// Throws AssetError for one that is not there, is empty, is sparse, has no buffer view or reaches beyond it.
    GltfAccessor(const tinygltf::Model& gltf, int index, std::string what);

    std::size_t count() const { return m_count; }
    int components() const { return m_components; }
    int component_type() const { return m_component_type; }
    bool normalized() const { return m_normalized; }
    const std::string& what() const { return m_what; }

    /// As glTF 2.0, section 3.6.2.4, says; normalized whole numbers become -1..1 or 0..1.
    /// Throws AssetError for one that is not finite.
    double number(std::size_t element, int component) const;
    /// Of whole numbers without a sign.
    std::uint32_t index(std::size_t element) const;

  private:
    double raw(const unsigned char* at) const;

    std::string m_what;
    const unsigned char* m_data;
    std::size_t m_count;
    std::size_t m_stride_bytes, m_component_bytes;
    int m_components, m_component_type;
    bool m_normalized;
};

}  // namespace sheer
