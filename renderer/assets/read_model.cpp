#include "renderer/assets/read_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <optional>
#include <utility>

#include "renderer/assets/file_bytes.h"
#include "renderer/assets/gltf_accessor.h"
#include "renderer/assets/gltf_materials.h"

namespace sheer {

namespace {

/// Floats hold such numbers well enough, and what is worked out from them stays finite.
constexpr double farthest_position = 1e9, farthest_uv = 65536;
constexpr std::size_t max_uses = 100000;

template <typename T>
const T& item(const std::vector<T>& list, int index, const char* name, const std::string& what) {
    if (index < 0 || static_cast<std::size_t>(index) >= list.size())
        throw AssetError(fmt::format("{}: there is no {} {}", what, name, index));
    return list[static_cast<std::size_t>(index)];
}

/// Of a node, relative to its parent.
glm::dmat4 transform_of(const tinygltf::Node& node, const std::string& what) {
    const auto check = [&](const std::vector<double>& numbers, std::size_t count, const char* name) {
        if (!numbers.empty() && numbers.size() != count)
            throw AssetError(fmt::format("{}: {} must have {} numbers, not {}", what, name, count, numbers.size()));
    };
    check(node.matrix, 16, "matrix");
    check(node.translation, 3, "translation");
    check(node.rotation, 4, "rotation");
    check(node.scale, 3, "scale");
    if (!node.matrix.empty()) return glm::make_mat4(node.matrix.data());
    glm::dmat4 transform(1);
    if (!node.translation.empty()) transform[3] = glm::dvec4(glm::make_vec3(node.translation.data()), 1);
    if (!node.rotation.empty()) {
        const glm::dquat rotation(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
        if (!(glm::length(rotation) > 1e-6)) throw AssetError(what + ": rotation has no length");
        transform *= glm::mat4_cast(glm::normalize(rotation));
    }
    if (!node.scale.empty())
        for (int axis = 0; axis < 3; ++axis) transform[axis] *= node.scale[static_cast<std::size_t>(axis)];
    return transform;
}

/// What turns normals when `world` moves points: the cofactors, which exist for flat transforms, too.
glm::dmat3 normal_transform(const glm::dmat3& world) {
    const glm::dmat3 cofactors(glm::cross(world[1], world[2]), glm::cross(world[2], world[0]),
                               glm::cross(world[0], world[1]));
    return glm::determinant(world) < 0 ? -cofactors : cofactors;
}

/// Of length 1; 0 for one without a direction.
glm::vec3 unit(const glm::dvec3& vector) {
    const double length = glm::length(vector);
    return length > 0 && std::isfinite(length) ? glm::vec3(vector / length) : glm::vec3(0);
}

glm::vec3 position(const GltfAccessor& accessor, std::size_t element, const glm::dmat4& world) {
    const glm::dvec4 local(accessor.number(element, 0), accessor.number(element, 1), accessor.number(element, 2), 1);
    const glm::dvec3 at(world * local);
    for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(at[axis]) <= farthest_position))
            throw AssetError(
                fmt::format("{}: element {} lies farther out than {:g}", accessor.what(), element, farthest_position));
    return glm::vec3(at);
}

glm::vec2 uv(const GltfAccessor& accessor, std::size_t element) {
    const glm::dvec2 at(accessor.number(element, 0), accessor.number(element, 1));
    if (std::max(std::abs(at.x), std::abs(at.y)) > farthest_uv)
        throw AssetError(
            fmt::format("{}: element {} lies farther out than {:g}", accessor.what(), element, farthest_uv));
    return glm::vec2(at);
}

glm::vec4 color(const GltfAccessor& accessor, std::size_t element) {
    const double alpha = accessor.components() == 4 ? accessor.number(element, 3) : 1;
    return {srgb_encode(accessor.number(element, 0)), srgb_encode(accessor.number(element, 1)),
            srgb_encode(accessor.number(element, 2)), static_cast<float>(std::clamp(alpha, 0.0, 1.0))};
}

void expect_components(const GltfAccessor& accessor, int least, int most) {
    if (accessor.components() < least || accessor.components() > most)
        throw AssetError(fmt::format("{} has {} numbers an element", accessor.what(), accessor.components()));
}

/// The corners of the triangles that `count` corners in a row make (glTF 2.0, section 3.7.2.1).
std::vector<std::uint32_t> triangle_corners(int mode, std::uint32_t count, const std::string& what) {
    std::vector<std::uint32_t> corners;
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        if (count % 3 != 0) throw AssetError(fmt::format("{}: {} corners are not whole triangles", what, count));
        for (std::uint32_t i = 0; i < count; ++i) corners.push_back(i);
        return corners;
    }
    for (std::uint32_t i = 0; i + 2 < count; ++i) {
        const std::array<std::uint32_t, 3> triangle = mode == TINYGLTF_MODE_TRIANGLE_STRIP
                                                          ? std::array{i, i + 1 + i % 2, i + 2 - i % 2}
                                                          : std::array{i + 1, i + 2, 0u};
        corners.insert(corners.end(), triangle.begin(), triangle.end());
    }
    return corners;
}

/// Gives every triangle vertices of its own, with its normal. `side` is -1 where a transform has mirrored them.
void add_flat_normals(ModelPart& part, double side) {
    std::vector<ModelVertex> vertices;
    for (std::size_t i = 0; i < part.indices.size(); i += 3) {
        std::array<ModelVertex, 3> corners;
        for (std::size_t corner = 0; corner < 3; ++corner) corners[corner] = part.vertices[part.indices[i + corner]];
        const glm::dvec3 first(corners[0].position), second(corners[1].position), third(corners[2].position);
        const glm::vec3 normal = unit(side * glm::cross(second - first, third - first));
        for (std::size_t corner = 0; corner < 3; ++corner) {
            corners[corner].normal = normal;
            part.indices[i + corner] = static_cast<std::uint32_t>(vertices.size());
            vertices.push_back(corners[corner]);
        }
    }
    part.vertices = std::move(vertices);
}

class ModelReader {
  public:
    ModelReader(const tinygltf::Model& gltf, const OtherFiles& others) : m_gltf(gltf), m_materials(gltf, others) {}

    Model read() {
        if (m_gltf.scenes.empty()) throw AssetError("the file has no scene");
        const int number = m_gltf.defaultScene == -1 ? 0 : m_gltf.defaultScene;
        visit_nodes(item(m_gltf.scenes, number, "scene", "the file").nodes, fmt::format("scene {}", number));
        for (const Use& use : m_uses) add_part(use);
        if (m_model.parts.empty()) throw AssetError("the file's scene has no triangles");
        m_model.materials = m_materials.materials();
        m_model.pictures = m_materials.read_pictures();
        return std::move(m_model);
    }

  private:
    /// A primitive of a mesh where a node puts it.
    struct Use {
        const tinygltf::Primitive& primitive;
        std::string what;
        glm::dmat4 world;
    };

    /// Finds all uses, in the order of the file, parents first; takes no memory for their vertices yet. A node may be
    /// met once: what is met again is a loop, or shared by two parents, which glTF forbids.
    void visit_nodes(const std::vector<int>& roots, const std::string& scene) {
        struct Visit {
            int node;
            glm::dmat4 parent;
            std::string from;
        };
        std::vector<bool> met(m_gltf.nodes.size());
        std::vector<Visit> ahead;
        const auto look_at = [&](const std::vector<int>& nodes, const glm::dmat4& parent, const std::string& from) {
            if (nodes.size() > met.size()) throw AssetError(from + " has more nodes below it than there are");
            for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) ahead.push_back({*node, parent, from});
        };
        look_at(roots, glm::dmat4(1), scene);
        while (!ahead.empty()) {
            const Visit visit = std::move(ahead.back());
            ahead.pop_back();
            const tinygltf::Node& node = item(m_gltf.nodes, visit.node, "node", visit.from);
            const std::string what = fmt::format("node {}", visit.node);
            if (met[static_cast<std::size_t>(visit.node)])
                throw AssetError(what + " is below itself or below two others; nodes must form trees");
            met[static_cast<std::size_t>(visit.node)] = true;
            const glm::dmat4 world = visit.parent * transform_of(node, what);
            if (node.mesh != -1) use_mesh(item(m_gltf.meshes, node.mesh, "mesh", what), node.mesh, world);
            look_at(node.children, world, what);
        }
    }

    void use_mesh(const tinygltf::Mesh& mesh, int number, const glm::dmat4& world) {
        for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
            Use use{mesh.primitives[i], fmt::format("mesh {}, primitive {}", number, i), world};
            const int mode = use.primitive.mode;
            if (mode < 0 || mode > TINYGLTF_MODE_TRIANGLE_FAN)
                throw AssetError(fmt::format("{}: there is no mode {}", use.what, mode));
            if (mode < TINYGLTF_MODE_TRIANGLES) continue;
            const std::size_t vertices = positions_of(use).count();
            const auto indices = indices_of(use);
            const std::size_t corners = indices ? indices->count() : vertices;
            count(vertices + (use.primitive.attributes.contains("NORMAL") ? 0 : corners), "vertices",
                  max_model_vertices, m_vertex_count);
            count(corners / (mode == TINYGLTF_MODE_TRIANGLES ? 3 : 1), "triangles", max_model_triangles,
                  m_triangle_count);
            if (m_uses.size() == max_uses)
                throw AssetError(fmt::format("the model uses meshes more than {} times", max_uses));
            m_uses.push_back(std::move(use));
        }
    }

    static void count(std::size_t more, const char* name, std::size_t most, std::size_t& sum) {
        if (more > most - sum) throw AssetError(fmt::format("the model has more than {} {}", most, name));
        sum += more;
    }

    std::optional<GltfAccessor> attribute(const Use& use, const std::string& name) const {
        const auto found = use.primitive.attributes.find(name);
        if (found == use.primitive.attributes.end()) return std::nullopt;
        return GltfAccessor(m_gltf, found->second, use.what + ": " + name);
    }

    GltfAccessor positions_of(const Use& use) const {
        const auto positions = attribute(use, "POSITION");
        if (!positions) throw AssetError(use.what + " has no POSITION");
        expect_components(*positions, 3, 3);
        return *positions;
    }

    std::optional<GltfAccessor> indices_of(const Use& use) const {
        if (use.primitive.indices == -1) return std::nullopt;
        GltfAccessor indices(m_gltf, use.primitive.indices, use.what + ": indices");
        expect_components(indices, 1, 1);
        const int type = indices.component_type();
        if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
            type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
            throw AssetError(indices.what() + " must be whole numbers without a sign");
        return indices;
    }

    void add_part(const Use& use) {
        const GltfAccessor positions = positions_of(use);
        ModelPart part;
        part.indices = corners_of(use, positions.count());
        if (part.indices.empty()) return;
        part.material = m_materials.use(use.primitive.material, use.what);
        add_vertices(use, positions, part);
        if (!use.primitive.attributes.contains("NORMAL"))
            add_flat_normals(part, glm::determinant(glm::dmat3(use.world)) < 0 ? -1 : 1);
        m_model.parts.push_back(std::move(part));
    }

    /// Indices of vertices, three for each triangle.
    std::vector<std::uint32_t> corners_of(const Use& use, std::size_t vertex_count) const {
        const auto indices = indices_of(use);
        const std::size_t count = indices ? indices->count() : vertex_count;
        auto corners = triangle_corners(use.primitive.mode, static_cast<std::uint32_t>(count), use.what);
        if (!indices) return corners;
        for (std::uint32_t& corner : corners) {
            const std::uint32_t index = indices->index(corner);
            if (index >= vertex_count)
                throw AssetError(
                    fmt::format("{}: {} is not one of the {} vertices", indices->what(), index, vertex_count));
            corner = index;
        }
        return corners;
    }

    void add_vertices(const Use& use, const GltfAccessor& positions, ModelPart& part) const {
        const auto normals = attribute(use, "NORMAL"), colors = attribute(use, "COLOR_0");
        std::optional<GltfAccessor> uvs;
        if (m_materials.materials()[part.material].picture >= 0) {
            const std::string name = fmt::format("TEXCOORD_{}", m_materials.uv_set(part.material));
            uvs = attribute(use, name);
            if (!uvs) throw AssetError(fmt::format("{} has a texture and no {}", use.what, name));
        }
        if (normals) expect_components(*normals, 3, 3);
        if (uvs) expect_components(*uvs, 2, 2);
        if (colors) expect_components(*colors, 3, 4);
        for (const std::optional<GltfAccessor>* other : {&normals, &colors, &std::as_const(uvs)})
            if (*other && (*other)->count() != positions.count())
                throw AssetError(fmt::format("{} has {} elements, and POSITION {}", (*other)->what(), (*other)->count(),
                                             positions.count()));
        const glm::dmat3 turn = normal_transform(glm::dmat3(use.world));
        for (std::size_t i = 0; i < positions.count(); ++i) {
            ModelVertex vertex{position(positions, i, use.world), glm::vec3(0), glm::vec2(0), glm::vec4(1)};
            if (normals)
                vertex.normal =
                    unit(turn * glm::dvec3(normals->number(i, 0), normals->number(i, 1), normals->number(i, 2)));
            if (uvs) vertex.uv = uv(*uvs, i);
            if (colors) vertex.color = color(*colors, i);
            part.vertices.push_back(vertex);
        }
    }

    const tinygltf::Model& m_gltf;
    GltfMaterials m_materials;
    std::vector<Use> m_uses;
    Model m_model;
    std::size_t m_vertex_count = 0, m_triangle_count = 0;
};

}  // namespace

Model read_model(std::string_view bytes, const OtherFiles& others) {
    const tinygltf::Model gltf = read_gltf_file(bytes, others);
    return ModelReader(gltf, others).read();
}

OtherFiles files_below(const std::filesystem::path& folder) {
    return [folder](const std::string& name) {
        std::error_code error;
        const std::filesystem::path root = std::filesystem::canonical(folder, error),
                                    file = error ? root : std::filesystem::canonical(root / name, error);
        if (error)
            throw AssetError(fmt::format("the file needs another file, \"{:.80}\", which is not there: {}", name,
                                         std::filesystem::absolute(folder / name).lexically_normal().string()));
        const auto [end, ignored] = std::mismatch(root.begin(), root.end(), file.begin(), file.end());
        if (end != root.end() || file == root)
            throw AssetError(fmt::format("the file needs another file, \"{:.80}\", which is not in its folder", name));
        return read_asset_bytes(file);
    };
}

}  // namespace sheer
