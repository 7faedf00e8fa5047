#include "renderer/assets/gltf_draco.h"

#include <draco/compression/decode.h>
#include <fmt/format.h>

#include "renderer/assets/gltf_accessor.h"
#include "renderer/assets/read_model.h"
#include "renderer/scene/assets.h"

namespace sheer {

namespace {

/// 0 for a type that glTF does not have.
std::uint64_t component_type_of(draco::DataType type) {
    switch (type) {
        case draco::DT_INT8:
            return gltf_component::int8;
        case draco::DT_UINT8:
            return gltf_component::uint8;
        case draco::DT_INT16:
            return gltf_component::int16;
        case draco::DT_UINT16:
            return gltf_component::uint16;
        case draco::DT_UINT32:
            return gltf_component::uint32;
        case draco::DT_FLOAT32:
            return gltf_component::float32;
        default:
            return 0;
    }
}

DracoMesh::Attribute read_attribute(const draco::Mesh& mesh, std::uint64_t id, const std::string& what) {
    const draco::PointAttribute* from =
        id > 0xffffffff ? nullptr : mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
    if (from == nullptr) throw AssetError(fmt::format("{} has no attribute {}", what, id));
    DracoMesh::Attribute attribute;
    attribute.components = from->num_components();
    attribute.component_type = component_type_of(from->data_type());
    if (attribute.component_type == 0 || attribute.components < 1 || attribute.components > 4)
        throw AssetError(fmt::format("{}: attribute {} has values of a type that glTF does not have", what, id));
    const auto size = static_cast<std::size_t>(draco::DataTypeLength(from->data_type()) * from->num_components());
    auto data = std::make_shared<std::string>(size * mesh.num_points(), '\0');
    for (draco::PointIndex point(0); point < mesh.num_points(); ++point) {
        const draco::AttributeValueIndex value = from->mapped_index(point);
        if (value.value() >= from->size()) throw AssetError(fmt::format("{}: attribute {} is cut off", what, id));
        from->GetValue(value, data->data() + size * point.value());
    }
    attribute.data = std::move(data);
    return attribute;
}

std::unique_ptr<draco::Mesh> decode_mesh(std::string_view bytes, const std::string& what) {
    draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    try {
        auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
        if (decoded.ok()) return std::move(decoded).value();
        throw AssetError(fmt::format("{} cannot be decoded: {}", what, decoded.status().error_msg()));
    } catch (const std::bad_alloc&) {
        throw AssetError(what + " cannot be decoded: it asks for too much memory");
    } catch (const std::length_error&) {
        throw AssetError(what + " cannot be decoded: it asks for too much memory");
    }
}

}  // namespace

DracoMesh decode_draco(std::string_view bytes, const std::vector<std::uint64_t>& ids, const std::string& what) {
    const std::unique_ptr<draco::Mesh> mesh = decode_mesh(bytes, what);
    DracoMesh decoded;
    decoded.vertex_count = mesh->num_points();
    if (decoded.vertex_count == 0 || mesh->num_faces() == 0) throw AssetError(what + " holds no triangles");
    if (decoded.vertex_count > max_model_vertices || mesh->num_faces() > max_model_triangles)
        throw AssetError(
            fmt::format("{} has more than {} vertices or {} triangles", what, max_model_vertices, max_model_triangles));
    for (draco::FaceIndex face(0); face < mesh->num_faces(); ++face)
        for (const draco::PointIndex& corner : mesh->face(face)) {
            if (corner.value() >= decoded.vertex_count)
                throw AssetError(
                    fmt::format("{}: {} is not one of its {} vertices", what, corner.value(), decoded.vertex_count));
            decoded.corners.push_back(corner.value());
        }
    for (const std::uint64_t id : ids) decoded.attributes.emplace(id, read_attribute(*mesh, id, what));
    return decoded;
}

}  // namespace sheer
