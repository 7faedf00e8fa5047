#include "renderer/assets/gltf_nodes.h"

#include <fmt/format.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <optional>
#include <utility>

#include "renderer/assets/gltf_accessor.h"

namespace sheer {

namespace {

constexpr std::size_t max_placements = 100000;

glm::dquat rotation_of(const glm::dvec4& xyzw, const std::string& what) {
    const glm::dquat rotation(xyzw.w, xyzw.x, xyzw.y, xyzw.z);
    if (!(glm::length(rotation) > 1e-6)) throw AssetError(what + ": rotation has no length");
    return glm::normalize(rotation);
}

glm::dmat4 transform_of(const glm::dvec3& translation, const glm::dquat& rotation, const glm::dvec3& scale) {
    glm::dmat4 transform = glm::mat4_cast(rotation);
    for (int axis = 0; axis < 3; ++axis) transform[axis] *= scale[axis];
    transform[3] = glm::dvec4(translation, 1);
    return transform;
}

/// Relative to its parent.
glm::dmat4 transform_of(const GltfObject& node) {
    const std::vector<double> matrix = node.numbers("matrix", 16), translation = node.numbers("translation", 3),
                              rotation = node.numbers("rotation", 4), scale = node.numbers("scale", 3);
    if (!matrix.empty()) return glm::make_mat4(matrix.data());
    return transform_of(
        translation.empty() ? glm::dvec3(0) : glm::make_vec3(translation.data()),
        rotation.empty() ? glm::dquat(1, 0, 0, 0) : rotation_of(glm::make_vec4(rotation.data()), node.what()),
        scale.empty() ? glm::dvec3(1) : glm::make_vec3(scale.data()));
}

/// The transforms of EXT_mesh_gpu_instancing, relative to the node.
class Instances {
  public:
    Instances(GltfFile& file, const GltfObject& extension) {
        const auto attributes = extension.object("attributes");
        if (!attributes) extension.fail("attributes is missing");
        m_translation = find(file, *attributes, "TRANSLATION", 3);
        m_rotation = find(file, *attributes, "ROTATION", 4);
        m_scale = find(file, *attributes, "SCALE", 3);
        for (const auto* accessor : {&m_translation, &m_rotation, &m_scale}) {
            if (!*accessor) continue;
            if (m_count && *m_count != (*accessor)->count())
                extension.fail(fmt::format("it has {} and {} instances", *m_count, (*accessor)->count()));
            m_count = (*accessor)->count();
        }
    }

    /// If none of the three attributes exists: one instance, at the node.
    std::size_t count() const { return m_count.value_or(1); }

    glm::dmat4 transform(std::size_t i, const std::string& what) const {
        const auto numbers = [&](const std::optional<GltfAccessor>& from, const glm::dvec4& otherwise) {
            glm::dvec4 read = otherwise;
            for (int component = 0; from && component < from->components(); ++component)
                read[component] = from->number(i, component);
            return read;
        };
        return transform_of(glm::dvec3(numbers(m_translation, {0, 0, 0, 0})),
                            rotation_of(numbers(m_rotation, {0, 0, 0, 1}), what),
                            glm::dvec3(numbers(m_scale, {1, 1, 1, 0})));
    }

  private:
    static std::optional<GltfAccessor> find(GltfFile& file, const GltfObject& attributes, const char* name,
                                            int components) {
        const auto index = attributes.whole_number(name);
        if (!index) return std::nullopt;
        GltfAccessor accessor(file, *index, attributes.what() + ": " + name);
        if (accessor.components() != components)
            throw AssetError(fmt::format("{} has {} numbers per element", accessor.what(), accessor.components()));
        return accessor;
    }

    std::optional<GltfAccessor> m_translation, m_rotation, m_scale;
    std::optional<std::size_t> m_count;
};

class Walk {
  public:
    explicit Walk(GltfFile& file) : m_file(file), m_met(file.count(gltf_lists::nodes)) {}

    std::vector<GltfPlacement> walk() {
        const std::size_t scenes = m_file.count(gltf_lists::scenes);
        if (scenes == 0) throw AssetError("the file has no scene");
        const std::uint64_t number = m_file.root().whole_number("scene").value_or(0);
        if (scenes > 1)
            m_file.note("other-scenes-ignored",
                        fmt::format("The file has {} scenes, of which scene {} is drawn.", scenes, number), "scenes");
        const GltfObject scene = m_file.item(gltf_lists::scenes, number, "the file");
        look_at(scene.whole_numbers("nodes"), glm::dmat4(1), scene.what());
        while (!m_ahead.empty()) {
            const Visit visit = std::move(m_ahead.back());
            m_ahead.pop_back();
            meet(visit);
        }
        return std::move(m_placements);
    }

  private:
    struct Visit {
        std::uint64_t node;
        glm::dmat4 parent;
        std::string from;
    };

    /// A node must be visited only once: a second visit means a loop or two parents, which glTF forbids.
    void look_at(const std::vector<std::uint64_t>& nodes, const glm::dmat4& parent, const std::string& from) {
        if (nodes.size() > m_met.size()) throw AssetError(from + " has more nodes below it than the file has");
        for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) m_ahead.push_back({*node, parent, from});
    }

    void meet(const Visit& visit) {
        const GltfObject node = m_file.item(gltf_lists::nodes, visit.node, visit.from);
        if (m_met[visit.node])
            throw AssetError(node.what() + " is below itself or below two others; nodes must form trees");
        m_met[visit.node] = true;
        if (const auto visibility = node.extension("KHR_node_visibility");
            visibility && visibility->has("visible") && !visibility->flag("visible"))
            return m_file.note("hidden-nodes", "Nodes that KHR_node_visibility hides are not drawn.", node.where());
        const glm::dmat4 world = visit.parent * transform_of(node);
        if (const auto mesh = node.whole_number("mesh")) place(node, *mesh, world);
        look_at(node.whole_numbers("children"), world, node.what());
    }

    void place(const GltfObject& node, std::uint64_t mesh, const glm::dmat4& world) {
        if (node.has("skin")) {
            if (!std::exchange(m_skin_noted, true))
                m_file.note("skin-at-rest", "Skinned meshes are drawn as they are stored: joints do not move them.",
                            node.where());
            return add({mesh, node.what(), glm::dmat4(1)});
        }
        const auto extension = node.extension("EXT_mesh_gpu_instancing");
        if (!extension) return add({mesh, node.what(), world});
        const Instances instances(m_file, *extension);
        for (std::size_t i = 0; i < instances.count(); ++i)
            add({mesh, node.what(), world * instances.transform(i, extension->what())});
    }

    void add(GltfPlacement placement) {
        if (m_placements.size() == max_placements)
            throw AssetError(fmt::format("the model uses meshes more than {} times", max_placements));
        m_placements.push_back(std::move(placement));
    }

    GltfFile& m_file;
    std::vector<bool> m_met;
    std::vector<Visit> m_ahead;
    std::vector<GltfPlacement> m_placements;
    bool m_skin_noted = false;
};

}  // namespace

std::vector<GltfPlacement> place_meshes(GltfFile& file) {
    return Walk(file).walk();
}

}  // namespace sheer
