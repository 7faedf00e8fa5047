// A model from a glTF 2.0 file. Triangles of materials with alphaMode BLEND are transparent, each a primitive of its
// own, sorted by the depth of its middle; those with OPAQUE and MASK are drawn before, with depth.
//
// The methods blend display values, so every factor is one: base colour and vertex colour are linear in the file and
// have been sRGB-encoded on their own, and the picture is used as it is stored. For a power law the product of encoded
// factors is the encoded product; sRGB differs from one near black only.
#include "renderer/scene/camera.h"
#include "renderer/scene/model.h"
#include "renderer/scene/solids.h"

namespace sheer {

namespace {

using glm::dvec3;

/// The whole of the scene's alpha test is in the materials: nothing lies under a cutoff of 0.
float cutoff_of(const Material& material) {
    return material.alpha == Material::Alpha::mask ? material.cutoff : 0;
}

class Builder {
  public:
    Builder(const Model& model, bool light) : m_model(model), m_light(light) {}

    Geometry build() {
        for (const Material& material : m_model.materials)
            m_geometry.materials.push_back({material.picture, cutoff_of(material)});
        m_geometry.pictures = m_model.pictures;
        move_uvs();
        for (const ModelPart& part : m_model.parts) {
            if (m_model.materials[part.material].alpha == Material::Alpha::blend) {
                add_triangles(part);
            } else {
                add_solid(part);
            }
        }
        return std::move(m_geometry);
    }

  private:
    /// Under 0 a texture coordinate has a meaning of its own (untextured_uv); pictures repeat, so whole numbers may be
    /// added.
    void move_uvs() {
        for (const ModelPart& part : m_model.parts)
            for (const ModelVertex& vertex : part.vertices) m_uv_shift = glm::max(m_uv_shift, -glm::floor(vertex.uv));
    }

    Vertex vertex(const ModelVertex& from, const ModelPart& part) const {
        const Material& material = m_model.materials[part.material];
        glm::vec4 tint = from.color * material.base_color;
        if (m_light && !material.unlit && from.normal != glm::vec3(0)) {
            const dvec3 lit = daylight(dvec3(glm::vec3(tint)), dvec3(from.normal));
            tint = glm::vec4(glm::vec3(glm::clamp(lit, 0.0, 1.0)), tint.a);
        }
        return {from.position, from.uv + m_uv_shift, tint, static_cast<std::uint32_t>(m_geometry.primitives.size()),
                part.material};
    }

    void add_solid(const ModelPart& part) {
        const auto first_vertex = static_cast<std::uint32_t>(m_geometry.vertices.size());
        const auto first_index = static_cast<std::uint32_t>(m_geometry.indices.size());
        for (const ModelVertex& from : part.vertices) m_geometry.vertices.push_back(vertex(from, part));
        for (const std::uint32_t index : part.indices) m_geometry.indices.push_back(first_vertex + index);
        m_geometry.primitives.push_back({first_index, static_cast<std::uint32_t>(part.indices.size()), 0, true});
    }

    void add_triangles(const ModelPart& part) {
        for (std::size_t i = 0; i < part.indices.size(); i += 3) {
            const auto first_index = static_cast<std::uint32_t>(m_geometry.indices.size());
            for (std::size_t corner = i; corner < i + 3; ++corner) {
                m_geometry.indices.push_back(static_cast<std::uint32_t>(m_geometry.vertices.size()));
                m_geometry.vertices.push_back(vertex(part.vertices[part.indices[corner]], part));
            }
            m_geometry.primitives.push_back({first_index, 3, 0, false});
        }
    }

    const Model& m_model;
    bool m_light;
    Geometry m_geometry;
    glm::vec2 m_uv_shift{0};
};

Geometry build_gltf(const nlohmann::json& scene, const ImageSpec& image, AssetReader& assets) {
    const Model model = assets.model(scene.at("model"));
    Geometry geometry = Builder(model, scene.at("light") == "daylight").build();
    add_notes_of(geometry.notes, model.notes, "/scene/model");
    const double aspect = static_cast<double>(image.width_px) / image.height_px;
    Sphere bounds = bounding_sphere(geometry.vertices);
    if (bounds.radius == 0) bounds.radius = 1;
    look_through(geometry, read_camera(scene.at("camera"), bounds, {0.35, 0.3, 1}, aspect), bounds, aspect);
    return geometry;
}

}  // namespace

SceneInfo scene_gltf() {
    return {
        .id = "gltf",
        .name = "glTF model",
        .summary = "A .glb or .gltf file: what blends is sorted by triangle; opaque and masked surfaces hide it.",
        .source = "Khronos, glTF 2.0",
        .parameters = {Param::asset("model", "a glTF 2.0 file, with all that it needs inside", "model", "", {}),
                       Param::choice("light",
                                     "daylight from the upper left, baked into the colours, or the colours as they are",
                                     "daylight", {"daylight", "none"}),
                       camera_parameter()},
        .default_shading = "material",
        .own_shading = "material",
        .check = check_camera,
        .build = build_gltf,
        .asset_field = "model",
    };
}

}  // namespace sheer
