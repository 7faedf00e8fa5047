#pragma once
#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "renderer/scene/scene_info.h"

namespace sheer {

struct Sphere {
    glm::dvec3 centre{0};
    double radius = 1;
};

/// How far ahead of the eye the near and the far plane lie.
struct Planes {
    double near = 1, far = 2;
};

/// Where a 3D scene is seen from, in the scene's right-handed space: y up, lengths without a unit.
struct Camera {
    glm::dvec3 eye, target, up;
    double fov_y_deg;  ///< the whole angle between the top and the bottom of the picture

    /// Scene to camera space: x right, y up, -z ahead. `origin` is where the scene's coordinates begin.
    glm::dmat4 view(const glm::dvec3& origin = glm::dvec3(0)) const;
    /// Camera to clip space with depth 0 (near) to 1, y up. `aspect` is width over height.
    glm::dmat4 projection(const Planes& planes, double aspect) const;
};

/// The camera of the spec, an optional object: absent or null frames the scene.
Param camera_parameter();

/// For SceneInfo::check. Adds an error if eye and target coincide or `up` does not define an upright direction. `scene`
/// holds a normalised `camera`; one that already has an error is not checked.
void check_camera(const nlohmann::json& scene, const std::string& pointer, std::vector<FieldError>& errors);

/// The camera of a normalised spec. If it is null: seen from `direction` relative to the sphere's centre, at the
/// distance at which the sphere touches the nearer edges of the picture.
Camera read_camera(const nlohmann::json& camera, const Sphere& bounds, const glm::dvec3& direction, double aspect);

/// The same as a field of a spec.
nlohmann::json camera_json(const Camera& camera);

/// Around the middle of the vertices' bounding box; not the smallest sphere, but close to it.
Sphere bounding_sphere(const std::vector<Vertex>& vertices);

/// Sets each primitive's depth to that of its middle (the mean of its vertices) ahead of the eye.
void set_depths(Geometry& geometry, const glm::dmat4& view);

/// Planes that fit the visible parts of the triangles tightly; what lies outside the view is ignored. The near plane is
/// never closer to the eye than a millionth of the distance of the farthest visible point.
Planes planes_of_view(const Geometry& geometry, const glm::dmat4& view, double fov_y_deg, double aspect);

/// Sets `view_projection`, `camera` and the depths. `origin` is where the geometry's coordinates begin, in the camera's
/// space.
void look_through(Geometry& geometry, const Camera& camera, double aspect, const glm::dvec3& origin = glm::dvec3(0));

/// The same for geometry that lies in camera space already.
void look_from_camera_space(Geometry& geometry, const Camera& camera, double aspect);

}  // namespace sheer
