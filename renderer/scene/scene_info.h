#pragma once
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "renderer/core/notes.h"
#include "renderer/image/image_spec.h"
#include "renderer/params/param.h"
#include "renderer/scene/assets.h"
#include "renderer/scene/picture_arrays.h"
#include "renderer/scene/shadings.h"
#include "renderer/scene/volume_shading.h"

namespace sheer {

struct Vertex {
    glm::vec3 position;       ///< before view_projection; with the identity: x right, y up, -1..1, depth 0 (near) to 1
    glm::vec2 uv;             ///< v down; untextured_uv: the tint alone, for opaque primitives
    glm::vec4 tint;           ///< straight color and alpha; colors may pass 1, methods clamp the shaded fragment
    std::uint32_t primitive;  ///< index into Geometry::primitives
    std::uint32_t material = 0;  ///< index into Geometry::materials, where there are any
};

/// If every vertex of an opaque primitive has this, its color is the tint, whatever the shading. No picture's
/// coordinates are this far out. (shaders/common/opaque.glsl.)
inline constexpr glm::vec2 untextured_uv{-1e9f, -1e9f};

/// What a sorted method orders: a quad, a sprite, a slice, a triangle.
struct Primitive {
    std::uint32_t first_index = 0;
    std::uint32_t index_count = 0;
    float depth = 0;  ///< of the centre, grows with the distance
    bool opaque = false;
};

/// How a material reads a picture: what shaders/scenes/materials.glsl knows of it, byte for byte.
struct SurfacePicture {
    std::int32_t array = -1;  ///< of the scene's picture arrays; -1 for no picture
    std::int32_t layer = 0;
    std::int32_t level = 0;     ///< that holds the picture itself
    std::int32_t sampling = 0;  ///< sampling_bits
};

/// What shaders/scenes/materials.glsl knows of a material, byte for byte.
struct SurfaceMaterial {
    SurfacePicture base, emission;
    glm::vec3 emitted{0};  ///< linear light
    float cutoff = 0;      ///< opaque fragments with less alpha are not drawn
};

/// A scene on the CPU. Primitives are in the order of submission.
struct Geometry {
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;  ///< triangles
    std::vector<Primitive> primitives;
    glm::mat4 view_projection{1.0f};
    nlohmann::json camera;  ///< where it is seen from, as in the spec; null for scenes without a camera
    std::vector<SurfaceMaterial> materials;
    std::vector<Picture> pictures;        ///< of the materials
    PictureArrays picture_arrays;         ///< where the pictures lie
    std::vector<glm::vec2> emission_uvs;  ///< of the vertices, if a material has an emission picture; otherwise empty
    /// Those of the textures that are files, square; by name and width in px.
    std::map<std::pair<std::string, int>, Picture> textures;
    std::optional<VolumeShading> volume;
    bool parallel = false;  ///< no primitives intersect and each has one depth, so drawing them in depth order is exact
    std::vector<Note> notes;  ///< of the files that the scene is made from

    /// Appends a rectangle parallel to the screen: corners in fractions of the image, origin top left, y down.
    /// `uv_turn` 0..7 picks one of the rotations and mirrorings of the texture.
    void add_rect(double x0, double y0, double x1, double y1, float depth, const glm::vec4& tint, bool opaque,
                  unsigned uv_turn = 0);
};

/// A scene type describes itself; the file renderer/scene/types/<id>.cpp ends with `SceneInfo scene_<id>()`.
struct SceneInfo {
    std::string id;
    std::string name;
    std::string summary;
    std::string source;                            ///< paper or "Sheer"
    std::vector<Param> parameters;                 ///< without those that every scene has, see all_parameters()
    Shading default_shading = shadings::constant;  ///< of a scene without its own
    std::string own_shading;  ///< its own shading, then the default: shaders/scenes/<own_shading>.glsl; "" for none
    std::string default_texture = "leaf";
    /// Adds errors that concern several fields together; null if there can be none. `scene` is normalised and at
    /// `pointer`.
    std::function<void(const nlohmann::json& scene, const std::string& pointer, std::vector<FieldError>& errors)> check;
    /// Throws AssetError, which becomes a SpecError at the field `asset_field` of the scene.
    std::function<Geometry(const nlohmann::json& scene, const ImageSpec& image, AssetReader& assets)> build;
    std::string asset_field;                             ///< what `build` reads with `assets`; "" for nothing
    std::string transparent = "transparent primitives";  ///< its name in messages: "The scene has no ..."

    /// Its own parameters and those of all scenes: shading and texture.
    std::vector<Param> all_parameters() const;
    /// Shading and texture, which a method may have of its own: its look.
    std::vector<Param> look_parameters() const;
};

/// Every scene type, from the generated table.
const std::vector<SceneInfo>& all_scenes();
/// Null if there is none with this id, which is case-insensitive.
const SceneInfo* find_scene(const std::string& id);

/// The scene of a normalised spec, with those of its textures that are files.
/// Throws SpecError for a file that cannot be used, at the field that refers to it.
Geometry build_geometry(const nlohmann::json& scene, const ImageSpec& image, AssetReader& assets);
/// Adds the textures of a look that are files, with errors as above; `pointer` is the method's.
void add_textures(const SceneInfo& info, const nlohmann::json& look, const std::string& pointer, AssetReader& assets,
                  Geometry& geometry);
/// Every file that a normalised scene refers to, with pointers from /scene.
std::vector<AssetReference> scene_assets(const nlohmann::json& scene);
/// Every file that a normalised look of such a scene refers to; `pointer` is the method's.
std::vector<AssetReference> look_assets(const SceneInfo& info, const nlohmann::json& look, const std::string& pointer);

/// A file that a scene drew from.
struct SourceFile {
    std::string pointer;  ///< the field of the spec that leads to it
    AssetFile file;

    bool operator==(const SourceFile&) const = default;
};
/// Those files that `assets` has read for these fields.
std::vector<SourceFile> source_files(const std::vector<AssetReference>& references, const AssetReader& assets);
/// {pointer, name, of, sha256, bytes} of each; `of` is null for a file that the spec itself names.
nlohmann::json to_json(const std::vector<SourceFile>& files);

}  // namespace sheer
