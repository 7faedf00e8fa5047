#pragma once
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "renderer/scene/scene_info.h"

namespace sheer {

struct Sphere {
    glm::dvec3 centre{0};
    double radius = 1;
};

/// Where a 3D scene is looked at from, in the scene's right-handed space: y up, lengths without a unit.
struct Camera {
    glm::dvec3 eye, target, up;
    double fov_y_deg;  ///< the whole angle between the top and the bottom of the picture

    /// Scene to camera space: x right, y up, -z ahead.
    glm::dmat4 view() const;
    /// Camera to clip space with depth 0 (near) to 1, y up. `aspect` is width over height. The planes hug `bounds`;
    /// from within them the near plane stays ahead of the eye by a thousandth of the far one's distance.
    glm::dmat4 projection(const Sphere& bounds, double aspect) const;
};

/// The camera of the spec, an optional object: absent or null frames the scene.
Param camera_parameter();

/// For SceneInfo::check. Adds an error where eye and target meet or `up` gives no upright direction. `scene` holds a
/// normalised `camera`; one that already has an error is not looked at.
void check_camera(const nlohmann::json& scene, const std::string& pointer, std::vector<FieldError>& errors);

/// The camera that a normalised spec means. Null: from `direction` off the sphere's centre, so far away that the sphere
/// touches the nearer edges of the picture.
Camera read_camera(const nlohmann::json& camera, const Sphere& bounds, const glm::dvec3& direction, double aspect);

/// The same as a field of a spec.
nlohmann::json camera_json(const Camera& camera);

/// Around the middle of the vertices' bounding box; not the smallest sphere, but close to it.
Sphere bounding_sphere(const std::vector<Vertex>& vertices);

/// Sets each primitive's depth to that of its middle (the mean of its vertices) ahead of the eye.
void set_depths(Geometry& geometry, const glm::dmat4& view);

/// Sets `view_projection`, `camera` and the depths.
void look_through(Geometry& geometry, const Camera& camera, const Sphere& bounds, double aspect);

}  // namespace sheer
