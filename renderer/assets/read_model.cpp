#include "renderer/assets/read_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <unordered_map>
#include <utility>

#include "renderer/assets/file_bytes.h"
#include "renderer/assets/gltf_materials.h"
#include "renderer/assets/gltf_nodes.h"
#include "renderer/assets/gltf_primitive.h"

namespace sheer {

namespace {

/// Results computed from such numbers stay finite as floats.
constexpr double farthest_position = 1e15, farthest_uv = 65536;
constexpr std::size_t max_uses = 100000;

/// The transform of normals when `world` transforms points: its cofactors, which also exist for singular transforms.
glm::dmat3 normal_transform(const glm::dmat3& world) {
    const glm::dmat3 cofactors(glm::cross(world[1], world[2]), glm::cross(world[2], world[0]),
                               glm::cross(world[0], world[1]));
    return glm::determinant(world) < 0 ? -cofactors : cofactors;
}

/// The vector with length 1; 0 if it has no direction.
glm::vec3 unit(const glm::dvec3& vector) {
    const double length = glm::length(vector);
    return length > 0 && std::isfinite(length) ? glm::vec3(vector / length) : glm::vec3(0);
}

glm::dvec3 position(const GltfAccessor& accessor, std::size_t element, const glm::dmat4& world) {
    const glm::dvec4 local(accessor.number(element, 0), accessor.number(element, 1), accessor.number(element, 2), 1);
    const glm::dvec3 at(world * local);
    for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(at[axis]) <= farthest_position))
            throw AssetError(
                fmt::format("{}: element {} is farther out than {:g}", accessor.what(), element, farthest_position));
    return at;
}

glm::vec2 uv(const GltfAccessor& accessor, std::size_t element, const GltfUv& from) {
    const glm::dvec2 at = from({accessor.number(element, 0), accessor.number(element, 1)});
    if (!(std::max(std::abs(at.x), std::abs(at.y)) <= farthest_uv))
        throw AssetError(fmt::format("{}: element {} is farther out than {:g}", accessor.what(), element, farthest_uv));
    return glm::vec2(at);
}

glm::vec4 color(const GltfAccessor& accessor, std::size_t element) {
    const double alpha = accessor.components() == 4 ? accessor.number(element, 3) : 1;
    return {srgb_encode(accessor.number(element, 0)), srgb_encode(accessor.number(element, 1)),
            srgb_encode(accessor.number(element, 2)), static_cast<float>(std::clamp(alpha, 0.0, 1.0))};
}

/// Gives every triangle vertices of its own, with its normal.
void add_flat_normals(ModelPart& part) {
    std::vector<ModelVertex> vertices;
    for (std::size_t i = 0; i < part.indices.size(); i += 3) {
        std::array<ModelVertex, 3> corners;
        for (std::size_t corner = 0; corner < 3; ++corner) corners[corner] = part.vertices[part.indices[i + corner]];
        const glm::dvec3 first(corners[0].position), second(corners[1].position), third(corners[2].position);
        const glm::vec3 normal = unit(glm::cross(second - first, third - first));
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
    explicit ModelReader(GltfFile& file) : m_file(file), m_pictures(file), m_materials(file, m_pictures) {}

    Model read() {
        for (GltfPlacement& placement : place_meshes(m_file)) use_mesh(placement);
        find_origin();
        for (const Use& use : m_uses) add_part(use);
        if (m_model.parts.empty()) throw AssetError("the file's scene has no triangles");
        note_the_rest();
        m_model.materials = m_materials.materials();
        m_model.pictures = m_pictures.read();
        m_model.notes = m_file.notes();
        return std::move(m_model);
    }

  private:
    /// A primitive of a mesh where a node puts it.
    struct Use {
        const GltfPrimitive& primitive;
        glm::dmat4 world;
    };

    const std::vector<GltfPrimitive>& primitives_of(const GltfPlacement& placement) {
        const auto [known, added] = m_primitives.try_emplace(placement.mesh);
        if (!added) return known->second;
        const GltfObject mesh = m_file.item(gltf_lists::meshes, placement.mesh, placement.what);
        for (const GltfObject& object : mesh.objects("primitives", "primitive")) {
            const GltfPrimitive& primitive = known->second.emplace_back(m_file, object);
            count(primitive.decoded_vertices(), "vertices", max_model_vertices, m_decoded_vertices);
            if (!primitive.is_triangles())
                m_file.note("primitives-ignored", "Points and lines are not drawn.", object.where());
            if (object.has("targets") && !std::exchange(m_morph_noted, true))
                m_file.note("morph-targets-ignored", "Morph targets are ignored: meshes keep their basic shape.",
                            object.where());
        }
        return known->second;
    }

    /// Does not allocate memory for the vertices yet.
    void use_mesh(const GltfPlacement& placement) {
        for (const GltfPrimitive& primitive : primitives_of(placement)) {
            if (!primitive.is_triangles()) continue;
            const std::size_t triangles = primitive.triangle_count();
            if (triangles == 0) continue;
            count(primitive.has("NORMAL") ? std::min(primitive.positions().count(), 3 * triangles) : 3 * triangles,
                  "vertices", max_model_vertices, m_vertex_count);
            count(triangles, "triangles", max_model_triangles, m_triangle_count);
            if (m_uses.size() == max_uses)
                throw AssetError(fmt::format("the model uses meshes more than {} times", max_uses));
            m_uses.push_back({primitive, placement.world});
        }
    }

    static void count(std::size_t more, const char* name, std::size_t most, std::size_t& sum) {
        if (more > most - sum) throw AssetError(fmt::format("the model has more than {} {}", most, name));
        sum += more;
    }

    void find_origin() {
        std::optional<std::pair<glm::dvec3, glm::dvec3>> box;
        for (const Use& use : m_uses) {
            const GltfAccessor positions = use.primitive.positions();
            for (const std::uint32_t corner : use.primitive.corners()) {
                const glm::dvec3 at = position(positions, corner, use.world);
                if (!box) box = {at, at};
                box = {glm::min(box->first, at), glm::max(box->second, at)};
            }
        }
        if (box) m_model.origin = (box->first + box->second) / 2.0;
    }

    void add_part(const Use& use) {
        ModelPart part;
        part.indices = use.primitive.corners();
        part.material = m_materials.use(use.primitive.object().whole_number("material"), use.primitive.what());
        // A mirrored mesh would show its back; the front in the file remains the front.
        if (glm::determinant(glm::dmat3(use.world)) < 0)
            for (std::size_t i = 0; i < part.indices.size(); i += 3)
                std::swap(part.indices[i + 1], part.indices[i + 2]);
        add_vertices(use, part);
        if (!use.primitive.has("NORMAL")) add_flat_normals(part);
        m_model.parts.push_back(std::move(part));
    }

    /// The texture coordinates that `picture` of the part's material uses.
    std::optional<GltfAccessor> uvs_of(const Use& use, const PictureUse& picture, const GltfUv& from) const {
        if (picture.picture < 0) return std::nullopt;
        const std::string name = fmt::format("TEXCOORD_{}", from.set);
        auto uvs = use.primitive.attribute(name, 2, 2);
        if (!uvs) throw AssetError(fmt::format("{} has a texture but no {}", use.primitive.what(), name));
        return uvs;
    }

    /// Adds each vertex that triangles use, once.
    void add_vertices(const Use& use, ModelPart& part) const {
        const GltfAccessor positions = use.primitive.positions();
        const Material& material = m_materials.materials()[part.material];
        const GltfUv &base_uv = m_materials.base_uv(part.material),
                     &emission_uv = m_materials.emission_uv(part.material);
        const auto normals = use.primitive.attribute("NORMAL", 3, 3), colors = use.primitive.attribute("COLOR_0", 3, 4),
                   base = uvs_of(use, material.base, base_uv), emission = uvs_of(use, material.emission, emission_uv);
        const glm::dmat3 turn = normal_transform(glm::dmat3(use.world));
        std::unordered_map<std::uint32_t, std::uint32_t> numbers;
        numbers.reserve(std::min(positions.count(), part.indices.size()));
        for (std::uint32_t& corner : part.indices) {
            const auto [known, added] = numbers.try_emplace(corner, static_cast<std::uint32_t>(part.vertices.size()));
            if (added) {
                const std::uint32_t i = corner;
                ModelVertex vertex{glm::vec3(position(positions, i, use.world) - m_model.origin), glm::vec3(0),
                                   glm::vec2(0), glm::vec4(1)};
                if (normals)
                    vertex.normal =
                        unit(turn * glm::dvec3(normals->number(i, 0), normals->number(i, 1), normals->number(i, 2)));
                if (base) vertex.uv = uv(*base, i, base_uv);
                if (emission) vertex.emission_uv = uv(*emission, i, emission_uv);
                if (colors) vertex.color = color(*colors, i);
                part.vertices.push_back(vertex);
            }
            corner = known->second;
        }
    }

    void note_the_rest() {
        const auto note = [&](const char* list, const std::string& code, const std::string& text) {
            if (const GltfObject& root = m_file.root(); root.has(list) && !root.fields().at(list).empty())
                m_file.note(code, text, list);
        };
        note("animations", "animations-ignored", "Animations are ignored: everything is where the nodes place it.");
        note("cameras", "cameras-ignored",
             "The file's cameras are ignored; the spec's field camera says where the scene is seen from.");
    }

    GltfFile& m_file;
    GltfPictures m_pictures;
    GltfMaterials m_materials;
    std::map<std::uint64_t, std::vector<GltfPrimitive>> m_primitives;  ///< by mesh
    std::vector<Use> m_uses;
    Model m_model;
    std::size_t m_vertex_count = 0, m_triangle_count = 0, m_decoded_vertices = 0;
    bool m_morph_noted = false;
};

}  // namespace

Model read_model(std::string_view bytes, const OtherFiles& others) {
    GltfFile file(bytes, others);
    return ModelReader(file).read();
}

OtherFiles files_below(const std::filesystem::path& folder) {
    return [folder](const std::string& name) {
        std::error_code error;
        const std::filesystem::path root = std::filesystem::canonical(folder, error),
                                    file = error ? root : std::filesystem::canonical(root / name, error);
        if (error)
            throw AssetError(fmt::format("the file needs another file, \"{:.80}\", which does not exist: {}", name,
                                         std::filesystem::absolute(folder / name).lexically_normal().string()));
        const auto [end, ignored] = std::mismatch(root.begin(), root.end(), file.begin(), file.end());
        if (end != root.end() || file == root)
            throw AssetError(fmt::format("the file needs another file, \"{:.80}\", which is not in its folder", name));
        return read_asset_bytes(file);
    };
}

}  // namespace sheer
