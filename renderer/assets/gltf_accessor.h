#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "renderer/assets/gltf_file.h"

namespace sheer {

/// The componentType of an accessor (glTF 2.0, section 3.6.2.2).
namespace gltf_component {
inline constexpr std::uint64_t int8 = 5120, uint8 = 5121, int16 = 5122, uint16 = 5123, uint32 = 5125, float32 = 5126;
}

/// The numbers of an accessor, which are all within its buffer. The file outlives it.
class GltfAccessor {
  public:
    /// `what` names it in errors, such as "mesh 0, primitive 1: POSITION". A sparse accessor is read with its
    /// substitutes, one without a buffer view as zeros.
    /// Throws AssetError for one that does not exist, is empty or exceeds its buffer view.
    GltfAccessor(GltfFile& file, std::uint64_t index, std::string what);

    /// Numbers that have already been decoded into `data`, one element after another.
    struct Layout {
        std::size_t count;
        int components;
        std::uint64_t component_type;
        bool normalized;
    };
    GltfAccessor(std::shared_ptr<const std::string> data, const Layout& layout, std::string what);

    std::size_t count() const { return m_layout.count; }
    int components() const { return m_layout.components; }
    std::uint64_t component_type() const { return m_layout.component_type; }
    const std::string& what() const { return m_what; }

    /// As in glTF 2.0, section 3.6.2.4; normalized whole numbers become -1..1 or 0..1.
    /// Throws AssetError for a number that is not finite.
    double number(std::size_t element, int component) const;
    /// For unsigned whole numbers.
    std::uint32_t index(std::size_t element) const;

  private:
    void read_layout(const GltfObject& accessor);
    /// Checks that `count` elements of `element_bytes` are within the view of `object`, and returns where they begin.
    struct Span {
        const char* data;
        std::size_t stride_bytes;
    };
    Span find_span(GltfFile& file, const GltfObject& object, std::size_t count, std::size_t element_bytes) const;
    void substitute(GltfFile& file, const GltfObject& sparse);
    std::size_t element_bytes() const;
    double raw(const char* at) const;
    [[noreturn]] void fail(const std::string& why) const;

    std::string m_what;
    Layout m_layout{};
    std::shared_ptr<const std::string> m_own;  ///< if the numbers are not in the file
    const char* m_data = nullptr;
    std::size_t m_stride_bytes = 0;
};

}  // namespace sheer
