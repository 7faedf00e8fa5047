// A model from a glTF 2.0 file. Triangles of materials with alphaMode BLEND are transparent, each a primitive of its
// own, sorted by the depth of its middle; those with OPAQUE and MASK are drawn first, with depth.
//
// The methods blend display values, so every factor is a display value: base color and vertex color are linear in the
// file and have each been sRGB-encoded, and the picture is used as it is stored. For a power law, the product of
// encoded factors is the encoded product; sRGB differs from a power law only near black.
#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "renderer/scene/camera.h"
#include "renderer/scene/model.h"
#include "renderer/scene/solids.h"

namespace sheer {

namespace {

using glm::dvec3;

/// What may be lost when equal values are interpolated, and when a product of two alphas is rounded; as fractions.
constexpr float interpolation_slack = 1.0f / 65536, product_slack = 1e-6f;

/// The alpha of its vertices, if they all have the same.
std::optional<float> constant_alpha(const ModelPart& part) {
    const float first = part.vertices.front().color.a;
    const bool same =
        std::ranges::all_of(part.vertices, [&](const ModelVertex& vertex) { return vertex.color.a == first; });
    return same ? std::optional(first) : std::nullopt;
}

/// How the alpha of a masked part is compared. Factors that are the same all over the part move into the cutoff, so
/// that an alpha equal to the cutoff is drawn however it is interpolated.
struct Mask {
    float cutoff = 0;    ///< of the remaining alpha; over 1 nothing is drawn
    bool varies = true;  ///< whether the vertices' alpha remains
};

Mask mask_of(const Material& material, const ModelPart& part) {
    const std::optional<float> alpha = constant_alpha(part);
    const float constant = material.base_color.a * alpha.value_or(1),
                slack = material.base_color.a < 1 && alpha.value_or(1) < 1 ? product_slack : 0;
    if (material.cutoff == 0) return {0, !alpha};
    if (constant < material.cutoff * (1 - slack)) return {2, !alpha};
    return {material.cutoff / constant * (1 - interpolation_slack), !alpha};
}

class Builder {
  public:
    /// `eye` is from the model's origin.
    Builder(const Model& model, bool light, const dvec3& eye) : m_model(model), m_light(light), m_eye(eye) {}

    Geometry build() {
        std::vector<glm::ivec2> sizes;
        for (const Picture& picture : m_model.pictures)
            sizes.emplace_back(picture.image.width_px, picture.image.height_px);
        m_geometry.picture_arrays = arrange_pictures(sizes);
        m_geometry.pictures = m_model.pictures;
        m_emission_uvs = std::ranges::any_of(m_model.materials,
                                             [](const Material& material) { return material.emission.picture >= 0; });
        for (const ModelPart& part : m_model.parts) add_part(part);
        return std::move(m_geometry);
    }

  private:
    void add_part(const ModelPart& part) {
        const Material& material = m_model.materials[part.material];
        const Mask mask = material.alpha == Material::Alpha::mask ? mask_of(material, part) : Mask{};
        if (mask.cutoff > 1)
            return add_note(
                m_geometry.notes,
                {"mask-hides-all", "Masked surfaces whose alpha is below their cutoff everywhere are not drawn.",
                 "/scene/model"});
        const auto [known, added] = m_numbers.try_emplace({part.material, mask.cutoff},
                                                          static_cast<std::uint32_t>(m_geometry.materials.size()));
        if (added)
            m_geometry.materials.push_back(
                {picture(material.base), picture(material.emission), material.emitted, mask.cutoff});
        m_surface = {&material, known->second, mask.varies};
        m_vertex_numbers.clear();
        if (material.alpha == Material::Alpha::blend) {
            add_triangles(part);
        } else {
            add_solid(part);
        }
    }

    SurfacePicture picture(const PictureUse& use) const {
        if (use.picture < 0) return {};
        const PictureArrays::Place& place = m_geometry.picture_arrays.places[static_cast<std::size_t>(use.picture)];
        return {place.array, place.layer, place.level, sampling_bits(use)};
    }

    enum class Side { front, back, hidden };

    /// Which side of the triangle that starts at corner `i` is seen. For one without an area it is the front.
    Side side_of(const ModelPart& part, std::size_t i) const {
        const auto at = [&](std::size_t corner) { return dvec3(part.vertices[part.indices[i + corner]].position); };
        const dvec3 first = at(0), normal = glm::cross(at(1) - first, at(2) - first);
        if (glm::dot(normal, m_eye - first) >= 0) return Side::front;
        return m_surface.material->double_sided ? Side::back : Side::hidden;
    }

    /// Adds a vertex, lit for the side that is seen.
    std::uint32_t add_vertex(const ModelVertex& from, Side side) {
        const Material& material = *m_surface.material;
        glm::vec4 tint = from.color * material.base_color;
        if (m_light && !material.unlit && from.normal != glm::vec3(0)) {
            const dvec3 normal(side == Side::back ? -from.normal : from.normal);
            tint = glm::vec4(glm::vec3(glm::clamp(daylight(dvec3(glm::vec3(tint)), normal), 0.0, 1.0)), tint.a);
        }
        if (material.alpha == Material::Alpha::mask) tint.a = m_surface.alpha_varies ? from.color.a : 1;
        if (m_emission_uvs) m_geometry.emission_uvs.push_back(from.emission_uv);
        m_geometry.vertices.push_back(
            {from.position, from.uv, tint, static_cast<std::uint32_t>(m_geometry.primitives.size()), m_surface.number});
        return static_cast<std::uint32_t>(m_geometry.vertices.size() - 1);
    }

    void add_solid(const ModelPart& part) {
        const auto first_index = static_cast<std::uint32_t>(m_geometry.indices.size());
        for (std::size_t i = 0; i < part.indices.size(); i += 3) {
            const Side side = side_of(part, i);
            if (side == Side::hidden) continue;
            for (std::size_t corner = i; corner < i + 3; ++corner) {
                const std::uint32_t index = part.indices[corner];
                const auto [known, added] = m_vertex_numbers.try_emplace({index, side});
                if (added) known->second = add_vertex(part.vertices[index], side);
                m_geometry.indices.push_back(known->second);
            }
        }
        const auto count = static_cast<std::uint32_t>(m_geometry.indices.size()) - first_index;
        if (count > 0) m_geometry.primitives.push_back({first_index, count, 0, true});
    }

    void add_triangles(const ModelPart& part) {
        for (std::size_t i = 0; i < part.indices.size(); i += 3) {
            const Side side = side_of(part, i);
            if (side == Side::hidden) continue;
            const auto first_index = static_cast<std::uint32_t>(m_geometry.indices.size());
            for (std::size_t corner = i; corner < i + 3; ++corner)
                m_geometry.indices.push_back(add_vertex(part.vertices[part.indices[corner]], side));
            m_geometry.primitives.push_back({first_index, 3, 0, false});
        }
    }

    const Model& m_model;
    bool m_light;
    dvec3 m_eye;
    Geometry m_geometry;
    bool m_emission_uvs = false;
    std::map<std::pair<std::uint32_t, float>, std::uint32_t> m_numbers;  ///< by the model's material and the cutoff
    /// Of the part that is being added.
    struct Surface {
        const Material* material = nullptr;
        std::uint32_t number = 0;
        bool alpha_varies = true;
    };
    Surface m_surface;
    std::map<std::pair<std::uint32_t, Side>, std::uint32_t> m_vertex_numbers;  ///< by the part's vertex and its side
};

/// Relative to the model's origin.
Sphere bounds_of(const Model& model) {
    dvec3 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
    const auto each = [&](const auto& action) {
        for (const ModelPart& part : model.parts)
            for (const ModelVertex& vertex : part.vertices) action(dvec3(vertex.position));
    };
    each([&](const dvec3& at) {
        low = glm::min(low, at);
        high = glm::max(high, at);
    });
    Sphere sphere{(low + high) / 2.0, 0};
    each([&](const dvec3& at) { sphere.radius = std::max(sphere.radius, glm::length(at - sphere.centre)); });
    if (sphere.radius == 0) sphere.radius = 1;
    return sphere;
}

Geometry build_gltf(const nlohmann::json& scene, const ImageSpec& image, AssetReader& assets) {
    const Model model = assets.model(scene.at("model"));
    const double aspect = static_cast<double>(image.width_px) / image.height_px;
    Sphere bounds = bounds_of(model);
    bounds.centre += model.origin;
    const Camera camera = read_camera(scene.at("camera"), bounds, {0.35, 0.3, 1}, aspect);
    Geometry geometry = Builder(model, scene.at("light") == "daylight", camera.eye - model.origin).build();
    add_notes_of(geometry.notes, model.notes, "/scene/model");
    look_through(geometry, camera, aspect, model.origin);
    return geometry;
}

}  // namespace

SceneInfo scene_gltf() {
    return {
        .id = "gltf",
        .name = "glTF model",
        .summary = "A .glb or .gltf file: blended triangles are sorted; opaque and masked surfaces hide them.",
        .source = "Khronos, glTF 2.0",
        .parameters = {Param::asset("model", "a glTF 2.0 file that contains everything it needs", "model", "", {}),
                       Param::choice("light",
                                     "daylight from the upper left, baked into the colors, or the colors as they are",
                                     "daylight", {"daylight", "none"}),
                       camera_parameter()},
        .own_shading = "material",
        .check = check_camera,
        .build = build_gltf,
        .asset_field = "model",
        .transparent = "triangles of a material that blends (alphaMode BLEND)",
    };
}

}  // namespace sheer
