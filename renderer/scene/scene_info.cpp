#include "renderer/scene/scene_info.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "renderer/core/names.h"
#include "renderer/glsl/own_shading.h"
#include "renderer/scene/textures.h"

namespace sheer {

namespace {

/// What forms begin with where the user's own shading is chosen.
constexpr const char* starter_glsl =
    "float rings = 0.5 + 0.5 * sin(60.0 * length(uv - 0.5));\n"
    "return vec4(tint.rgb * rings, tint.a);\n";

}  // namespace

std::vector<SceneInfo> make_scenes();

const std::vector<SceneInfo>& all_scenes() {
    static const std::vector<SceneInfo> scenes = make_scenes();
    return scenes;
}

const SceneInfo* find_scene(const std::string& id) {
    return find_by_id(all_scenes(), id);
}

std::vector<Param> SceneInfo::all_parameters() const {
    std::vector<Param> all = parameters;
    std::ranges::move(look_parameters(), std::back_inserter(all));
    return all;
}

std::vector<Param> SceneInfo::look_parameters() const {
    std::vector<std::string> names;
    for (const Shading& shading : shadings::all) names.emplace_back(shading.name);
    if (!own_shading.empty()) names.push_back(own_shading);
    Param glsl = Param::text("glsl", "body of vec4 real_work(vec2 uv, vec4 tint), see docs/shading.md", starter_glsl,
                             max_glsl_bytes);
    glsl.min_length = 1;
    return {Param::choice_or_object("shading",
                                    "what the fragment shader does: read textures and bend positions, or your own GLSL",
                                    own_shading.empty() ? std::string(default_shading.name) : own_shading,
                                    std::move(names), {glsl.required()}),
            Param::object("texture", "the four textures that the shading reads",
                          {Param::asset("image", "their picture: one name for all four, or one for each", "texture",
                                        default_texture, {"leaf", "smoke"})
                               .or_each_of(texture_count),
                           Param::integer("size", "width and height", "px", 1024, 1, 4096),
                           Param::number("coverage_alpha",
                                         "mipmaps keep the share of the picture with at least this alpha, so that "
                                         "leaves do not dissolve in the distance under an alpha test; 0: plain means",
                                         "", 0, 0, 1)})};
}

Geometry build_geometry(const nlohmann::json& scene, const ImageSpec& image, AssetReader& assets) {
    const SceneInfo& info = *find_scene(scene.at("type"));
    Geometry geometry;
    try {
        geometry = info.build(scene, image, assets);
    } catch (const AssetError& error) {
        throw SpecError(std::vector<FieldError>{{"/scene/" + info.asset_field, error.what()}});
    }
    add_textures(info, scene, "/scene", assets, geometry);
    return geometry;
}

void add_textures(const SceneInfo& info, const nlohmann::json& look, const std::string& pointer, AssetReader& assets,
                  Geometry& geometry) {
    for (const AssetReference& reference : look_assets(info, look, pointer)) {
        const int size_px = look.at("texture").at("size");
        if (geometry.textures.contains({reference.name, size_px})) continue;
        try {
            const Picture& picture =
                geometry.textures
                    .emplace(std::pair(reference.name, size_px), assets.picture(reference.name, size_px, size_px))
                    .first->second;
            add_notes_of(geometry.notes, picture.notes, reference.pointer);
        } catch (const AssetError& error) {
            throw SpecError(std::vector<FieldError>{{reference.pointer, error.what()}});
        }
    }
}

std::vector<AssetReference> look_assets(const SceneInfo& info, const nlohmann::json& look, const std::string& pointer) {
    std::vector<Param> fields = info.look_parameters();
    std::erase_if(fields, [&](const Param& field) { return !look.contains(field.name); });
    return find_assets(look, pointer, fields);
}

std::vector<AssetReference> scene_assets(const nlohmann::json& scene) {
    return find_assets(scene, "/scene", find_scene(scene.at("type"))->all_parameters());
}

std::vector<SourceFile> source_files(const std::vector<AssetReference>& references, const AssetReader& assets) {
    std::vector<SourceFile> found;
    const std::vector<AssetFile> files = assets.files();
    for (const AssetReference& reference : references)
        for (const AssetFile& file : files)
            if (file.of.empty() ? file.name == reference.name : file.of == reference.name)
                found.push_back({reference.pointer, file});
    return found;
}

nlohmann::json to_json(const std::vector<SourceFile>& files) {
    nlohmann::json all = nlohmann::json::array();
    for (const auto& [pointer, file] : files)
        all.push_back({{"pointer", pointer},
                       {"name", file.name},
                       {"of", file.of.empty() ? nlohmann::json() : nlohmann::json(file.of)},
                       {"sha256", file.sha256},
                       {"bytes", file.bytes}});
    return all;
}

void Geometry::add_rect(double x0, double y0, double x1, double y1, float depth, const glm::vec4& tint, bool opaque,
                        unsigned uv_turn) {
    const auto primitive = static_cast<std::uint32_t>(primitives.size());
    const auto first_vertex = static_cast<std::uint32_t>(vertices.size());
    const std::array<glm::dvec2, 4> corners = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    for (unsigned i = 0; i < 4; ++i) {
        const glm::dvec2 at(x0 + corners[i].x * (x1 - x0), y0 + corners[i].y * (y1 - y0));
        glm::vec2 uv(corners[(i + uv_turn) % 4]);
        if (uv_turn >= 4) uv.x = 1 - uv.x;
        vertices.push_back({{2 * at.x - 1, 1 - 2 * at.y, depth}, uv, tint, primitive});
    }
    primitives.push_back({static_cast<std::uint32_t>(indices.size()), 6, depth, opaque});
    for (const std::uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) indices.push_back(first_vertex + corner);
}

}  // namespace sheer
