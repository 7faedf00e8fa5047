#include "renderer/assets/gltf_primitive.h"

#include <fmt/format.h>

#include <array>

namespace sheer {

namespace {

void expect_components(const GltfAccessor& accessor, int least, int most) {
    if (accessor.components() < least || accessor.components() > most)
        throw AssetError(fmt::format("{} has {} numbers per element", accessor.what(), accessor.components()));
}

}  // namespace

GltfPrimitive::GltfPrimitive(GltfFile& file, const GltfObject& object)
    : m_file(file), m_object(object), m_mode(object.whole_number("mode").value_or(mode_triangles)) {
    if (m_mode > mode_fan) object.fail(fmt::format("there is no mode {}", m_mode));
    m_attributes = object.object("attributes");
    if (const auto draco = object.extension("KHR_draco_mesh_compression"); draco && is_triangles()) decode(*draco);
}

void GltfPrimitive::decode(const GltfObject& draco) {
    m_draco_ids = draco.object("attributes");
    if (!m_draco_ids) draco.fail("attributes is missing");
    std::vector<std::uint64_t> ids;
    for (const auto& [name, ignored] : m_draco_ids->fields().items())
        ids.push_back(m_draco_ids->needed_number(name.c_str()));
    m_draco = decode_draco(m_file.view(draco.needed_number("bufferView"), draco.what()).bytes, ids, draco.what());
}

bool GltfPrimitive::has(const std::string& attribute) const {
    return (m_attributes && m_attributes->has(attribute.c_str())) || (m_draco && m_draco_ids->has(attribute.c_str()));
}

GltfAccessor GltfPrimitive::find(const std::string& name) const {
    const std::string called = what() + ": " + name;
    if (!m_draco || !m_draco_ids->has(name.c_str())) return {m_file, m_attributes->needed_number(name.c_str()), called};
    const DracoMesh::Attribute& decoded = m_draco->attributes.at(m_draco_ids->needed_number(name.c_str()));
    // The accessor says whether whole numbers are fractions.
    bool normalized = false;
    if (m_attributes && m_attributes->has(name.c_str()))
        normalized =
            m_file.item(gltf_lists::accessors, m_attributes->needed_number(name.c_str()), called).flag("normalized");
    return {decoded.data, {m_draco->vertex_count, decoded.components, decoded.component_type, normalized}, called};
}

GltfAccessor GltfPrimitive::positions() const {
    if (!has("POSITION")) throw AssetError(what() + " has no POSITION");
    GltfAccessor positions = find("POSITION");
    expect_components(positions, 3, 3);
    return positions;
}

std::optional<GltfAccessor> GltfPrimitive::attribute(const std::string& name, int least, int most) const {
    if (!has(name)) return std::nullopt;
    GltfAccessor found = find(name);
    expect_components(found, least, most);
    if (const std::size_t vertices = positions().count(); found.count() != vertices)
        throw AssetError(fmt::format("{} has {} elements, but POSITION has {}", found.what(), found.count(), vertices));
    return found;
}

std::optional<GltfAccessor> GltfPrimitive::indices() const {
    const auto index = m_object.whole_number("indices");
    if (!index) return std::nullopt;
    GltfAccessor indices(m_file, *index, what() + ": indices");
    expect_components(indices, 1, 1);
    const std::uint64_t type = indices.component_type();
    if (type != gltf_component::uint8 && type != gltf_component::uint16 && type != gltf_component::uint32)
        throw AssetError(indices.what() + " must be unsigned whole numbers");
    return indices;
}

std::size_t GltfPrimitive::triangle_count() const {
    if (m_draco) return m_draco->corners.size() / 3;
    const auto listed = indices();
    const std::size_t corners = listed ? listed->count() : positions().count();
    if (m_mode == mode_triangles) {
        if (corners % 3 != 0)
            throw AssetError(fmt::format("{}: the number of corners, {}, is not a multiple of 3", what(), corners));
        return corners / 3;
    }
    return corners < 3 ? 0 : corners - 2;
}

std::vector<std::uint32_t> GltfPrimitive::corners() const {
    if (m_draco) return m_draco->corners;
    const auto listed = indices();
    const std::size_t vertices = positions().count(), triangles = triangle_count();
    std::vector<std::uint32_t> corners;
    corners.reserve(triangles * 3);
    for (std::uint32_t i = 0; i < triangles; ++i) {
        std::array<std::uint32_t, 3> triangle{3 * i, 3 * i + 1, 3 * i + 2};
        if (m_mode == mode_strip) triangle = {i, i + 1 + i % 2, i + 2 - i % 2};
        if (m_mode == mode_fan) triangle = {i + 1, i + 2, 0};
        for (const std::uint32_t corner : triangle) {
            const std::uint32_t index = listed ? listed->index(corner) : corner;
            if (index >= vertices)
                throw AssetError(fmt::format("{}: {} is not one of the {} vertices", listed ? listed->what() : what(),
                                             index, vertices));
            corners.push_back(index);
        }
    }
    return corners;
}

}  // namespace sheer
