#include "renderer/assets/gltf_accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "renderer/scene/assets.h"

namespace sheer {

namespace {

/// Sparse accessors and those without a buffer view may ask for any number of zeros.
constexpr std::size_t max_own_elements = 12000000;

template <typename T>
double as_double(const char* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return static_cast<double>(value);
}

struct ComponentType {
    std::uint64_t type;
    std::size_t bytes;
    double largest;  ///< the divisor of normalized numbers
    double (*read)(const char* at);
};

constexpr std::array component_types = {
    ComponentType{gltf_component::int8, 1, 127, as_double<std::int8_t>},
    ComponentType{gltf_component::uint8, 1, 255, as_double<std::uint8_t>},
    ComponentType{gltf_component::int16, 2, 32767, as_double<std::int16_t>},
    ComponentType{gltf_component::uint16, 2, 65535, as_double<std::uint16_t>},
    ComponentType{gltf_component::uint32, 4, 4294967295.0, as_double<std::uint32_t>},
    ComponentType{gltf_component::float32, 4, 1, as_double<float>}};

/// Null for a type that glTF does not have.
const ComponentType* find_component_type(std::uint64_t type) {
    const auto* found = std::ranges::find(component_types, type, &ComponentType::type);
    return found == component_types.end() ? nullptr : found;
}

int component_count(const std::string& type) {
    if (type == "SCALAR") return 1;
    return type == "VEC2" ? 2 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 0;
}

}  // namespace

void GltfAccessor::fail(const std::string& why) const {
    throw AssetError(m_what + " " + why);
}

GltfAccessor::GltfAccessor(GltfFile& file, std::uint64_t index, std::string what) : m_what(std::move(what)) {
    const GltfObject accessor = file.item(gltf_lists::accessors, index, m_what);
    read_layout(accessor);
    m_stride_bytes = element_bytes();
    const auto sparse = accessor.object("sparse");
    const bool viewed = accessor.has("bufferView");
    if (viewed) {
        const Span span = find_span(file, accessor, m_layout.count, element_bytes());
        m_data = span.data;
        m_stride_bytes = span.stride_bytes;
    }
    if (viewed && !sparse) return;
    if (m_layout.count > max_own_elements)
        fail(fmt::format("has {} elements; a sparse accessor may have at most {}", m_layout.count, max_own_elements));
    auto own = std::make_shared<std::string>(m_layout.count * element_bytes(), '\0');
    for (std::size_t i = 0; viewed && i < m_layout.count; ++i)
        std::memcpy(own->data() + i * element_bytes(), m_data + i * m_stride_bytes, element_bytes());
    m_stride_bytes = element_bytes();
    m_data = own->data();
    m_own = std::move(own);
    if (sparse) substitute(file, *sparse);
}

GltfAccessor::GltfAccessor(std::shared_ptr<const std::string> data, const Layout& layout, std::string what)
    : m_what(std::move(what)), m_layout(layout), m_own(std::move(data)), m_data(m_own->data()) {
    m_stride_bytes = element_bytes();
}

void GltfAccessor::read_layout(const GltfObject& accessor) {
    const auto type = accessor.text("type");
    m_layout = {accessor.needed_number("count"), component_count(type), accessor.needed_number("componentType"),
                accessor.flag("normalized")};
    if (m_layout.count == 0) fail("is empty");
    if (m_layout.components == 0) fail(fmt::format("has the type \"{:.20}\"", type));
    if (find_component_type(m_layout.component_type) == nullptr)
        fail(fmt::format("has the component type {}", m_layout.component_type));
}

std::size_t GltfAccessor::element_bytes() const {
    return find_component_type(m_layout.component_type)->bytes * static_cast<std::size_t>(m_layout.components);
}

GltfAccessor::Span GltfAccessor::find_span(GltfFile& file, const GltfObject& object, std::size_t count,
                                           std::size_t size) const {
    const GltfView view = file.view(object.needed_number("bufferView"), m_what);
    const std::size_t stride = view.stride_bytes == 0 ? size : view.stride_bytes,
                      offset = object.whole_number("byteOffset").value_or(0), whole = view.bytes.size();
    if (stride < size) fail("has a stride smaller than its elements");
    if (offset > whole || size > whole - offset || count - 1 > (whole - offset - size) / stride)
        fail(fmt::format("has {} elements, which exceed its buffer view of {} bytes", count, whole));
    return {view.bytes.data() + offset, stride};
}

void GltfAccessor::substitute(GltfFile& file, const GltfObject& sparse) {
    const auto indices = sparse.object("indices"), values = sparse.object("values");
    if (!indices || !values) fail("is sparse without indices or values");
    const std::size_t count = sparse.needed_number("count");
    if (count == 0 || count > m_layout.count)
        fail(fmt::format("is sparse with {} values for {} elements", count, m_layout.count));
    const ComponentType* type = find_component_type(indices->needed_number("componentType"));
    if (type == nullptr || (type->type != gltf_component::uint8 && type->type != gltf_component::uint16 &&
                            type->type != gltf_component::uint32))
        fail("is sparse with indices that are not unsigned whole numbers");
    const Span from = find_span(file, *values, count, element_bytes()),
               at = find_span(file, *indices, count, type->bytes);
    auto own = std::make_shared<std::string>(*m_own);
    for (std::size_t i = 0; i < count; ++i) {
        const auto element = static_cast<std::size_t>(type->read(at.data + i * at.stride_bytes));
        if (element >= m_layout.count)
            fail(fmt::format("is sparse: {} is not one of its {} elements", element, m_layout.count));
        std::memcpy(own->data() + element * element_bytes(), from.data + i * from.stride_bytes, element_bytes());
    }
    m_data = own->data();
    m_own = std::move(own);
}

double GltfAccessor::raw(const char* at) const {
    return find_component_type(m_layout.component_type)->read(at);
}

double GltfAccessor::number(std::size_t element, int component) const {
    const ComponentType& type = *find_component_type(m_layout.component_type);
    const double value =
        type.read(m_data + element * m_stride_bytes + static_cast<std::size_t>(component) * type.bytes);
    if (!std::isfinite(value)) throw AssetError(fmt::format("{}: element {} is not a finite number", m_what, element));
    return m_layout.normalized ? std::max(value / type.largest, -1.0) : value;
}

std::uint32_t GltfAccessor::index(std::size_t element) const {
    return static_cast<std::uint32_t>(raw(m_data + element * m_stride_bytes));
}

}  // namespace sheer
