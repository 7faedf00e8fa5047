#include "renderer/assets/gltf_accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "renderer/scene/assets.h"

namespace sheer {

namespace {

template <typename T>
double as_double(const unsigned char* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return static_cast<double>(value);
}

/// 0 for one that glTF does not have.
double largest(int component_type) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return std::numeric_limits<std::int8_t>::max();
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return std::numeric_limits<std::uint8_t>::max();
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return std::numeric_limits<std::int16_t>::max();
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return std::numeric_limits<std::uint16_t>::max();
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return std::numeric_limits<std::uint32_t>::max();
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return 1;
        default:
            return 0;
    }
}

}  // namespace

GltfAccessor::GltfAccessor(const tinygltf::Model& gltf, int index, std::string what) : m_what(std::move(what)) {
    const auto fail = [this](const std::string& why) -> void { throw AssetError(m_what + " " + why); };
    if (index < 0 || static_cast<std::size_t>(index) >= gltf.accessors.size())
        fail(fmt::format("is accessor {}, which is not there", index));
    const tinygltf::Accessor& accessor = gltf.accessors[static_cast<std::size_t>(index)];
    if (accessor.sparse.isSparse) fail("is sparse, which is not read");
    if (accessor.bufferView < 0 || static_cast<std::size_t>(accessor.bufferView) >= gltf.bufferViews.size())
        fail(fmt::format("is in buffer view {}, which is not there", accessor.bufferView));
    if (accessor.count == 0) fail("is empty");
    if (largest(accessor.componentType) == 0) fail(fmt::format("has the component type {}", accessor.componentType));

    const tinygltf::BufferView& view = gltf.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
    m_components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
    m_component_type = accessor.componentType;
    m_normalized = accessor.normalized;
    m_component_bytes =
        static_cast<std::size_t>(tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(m_component_type)));
    const std::size_t element_bytes = m_component_bytes * static_cast<std::size_t>(m_components);
    m_stride_bytes = view.byteStride == 0 ? element_bytes : view.byteStride;
    m_count = accessor.count;
    if (m_stride_bytes < element_bytes) fail("has a stride smaller than its elements");
    if (accessor.byteOffset > view.byteLength || element_bytes > view.byteLength - accessor.byteOffset ||
        m_count - 1 > (view.byteLength - accessor.byteOffset - element_bytes) / m_stride_bytes)
        fail(fmt::format("has {} elements, which reach beyond its buffer view of {} bytes", m_count, view.byteLength));
    m_data = gltf.buffers.at(static_cast<std::size_t>(view.buffer)).data.data() + view.byteOffset + accessor.byteOffset;
}

double GltfAccessor::raw(const unsigned char* at) const {
    switch (m_component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return as_double<std::int8_t>(at);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return as_double<std::uint8_t>(at);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return as_double<std::int16_t>(at);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return as_double<std::uint16_t>(at);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return as_double<std::uint32_t>(at);
        default:
            return as_double<float>(at);
    }
}

double GltfAccessor::number(std::size_t element, int component) const {
    const double value =
        raw(m_data + element * m_stride_bytes + static_cast<std::size_t>(component) * m_component_bytes);
    if (!std::isfinite(value)) throw AssetError(fmt::format("{}: element {} is not a finite number", m_what, element));
    return m_normalized ? std::max(value / largest(m_component_type), -1.0) : value;
}

std::uint32_t GltfAccessor::index(std::size_t element) const {
    return static_cast<std::uint32_t>(raw(m_data + element * m_stride_bytes));
}

}  // namespace sheer
