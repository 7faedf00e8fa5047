#include "renderer/scene/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace sheer {

namespace {

constexpr double default_fov_y_deg = 40;
constexpr double farthest = 1000;
constexpr double least_sine = 1e-6;  // of the angle between `up` and the line of sight

glm::dvec3 vector_of(const nlohmann::json& numbers) {
    const auto values = numbers.get<std::array<double, 3>>();
    return {values[0], values[1], values[2]};
}

double half_height(double fov_y_deg) {
    return std::tan(glm::radians(fov_y_deg) / 2);
}

}  // namespace

glm::dmat4 Camera::view() const {
    return glm::lookAtRH(eye, target, up);
}

glm::dmat4 Camera::projection(const Sphere& bounds, double aspect) const {
    const double distance = glm::length(bounds.centre - eye);
    const double far_plane = distance + bounds.radius;
    const double near_plane = std::max(distance - bounds.radius, far_plane / 1000);
    return glm::perspectiveRH_ZO(glm::radians(fov_y_deg), aspect, near_plane, far_plane);
}

Param camera_parameter() {
    Param camera = Param::object(
        "camera", "where the scene is looked at from; without one all of it is in the picture",
        {Param::numbers("eye", "where the camera is: x, y, z with y up", "", {4, 3, 6}, -farthest, farthest),
         Param::numbers("target", "what is in the middle of the picture", "", {0, 1.5, 0}, -farthest, farthest),
         Param::numbers("up", "what points up in the picture", "", {0, 1, 0}, -farthest, farthest),
         Param::number("fov_y_deg", "angle between the top and the bottom of the picture", "deg", default_fov_y_deg, 1,
                       170)});
    camera.optional = true;
    return camera;
}

void check_camera(const nlohmann::json& scene, const std::string& pointer, std::vector<FieldError>& errors) {
    const nlohmann::json& camera = scene.at("camera");
    const std::string own = pointer + "/camera";
    const bool wrong =
        std::ranges::any_of(errors, [&](const FieldError& error) { return error.pointer.starts_with(own); });
    if (camera.is_null() || wrong) return;
    const glm::dvec3 sight = vector_of(camera.at("target")) - vector_of(camera.at("eye")),
                     up = vector_of(camera.at("up"));
    if (glm::length(sight) < least_sine) {
        errors.push_back({own + "/target", "must differ from eye"});
    } else if (glm::length(up) < least_sine) {
        errors.push_back({own + "/up", "must have a length"});
    } else if (glm::length(glm::cross(glm::normalize(sight), glm::normalize(up))) < least_sine) {
        errors.push_back({own + "/up", "must not be parallel to the line from eye to target"});
    }
}

Camera read_camera(const nlohmann::json& camera, const Sphere& bounds, const glm::dvec3& direction, double aspect) {
    if (!camera.is_null())
        return {vector_of(camera.at("eye")), vector_of(camera.at("target")), vector_of(camera.at("up")),
                camera.at("fov_y_deg").get<double>()};
    // A cone of half angle a touches a sphere of radius r at the distance r / sin(a) of its tip.
    const double tangent = half_height(default_fov_y_deg) * std::min(aspect, 1.0);
    const double sine = tangent / std::sqrt(1 + tangent * tangent);
    return {bounds.centre + glm::normalize(direction) * (bounds.radius / sine),
            bounds.centre,
            {0, 1, 0},
            default_fov_y_deg};
}

nlohmann::json camera_json(const Camera& camera) {
    const auto numbers = [](const glm::dvec3& vector) { return nlohmann::json{vector.x, vector.y, vector.z}; };
    return {{"eye", numbers(camera.eye)},
            {"target", numbers(camera.target)},
            {"up", numbers(camera.up)},
            {"fov_y_deg", camera.fov_y_deg}};
}

Sphere bounding_sphere(const std::vector<Vertex>& vertices) {
    if (vertices.empty()) return {};
    glm::dvec3 low(vertices.front().position), high = low;
    for (const Vertex& vertex : vertices) {
        low = glm::min(low, glm::dvec3(vertex.position));
        high = glm::max(high, glm::dvec3(vertex.position));
    }
    Sphere sphere{(low + high) / 2.0, 0};
    for (const Vertex& vertex : vertices)
        sphere.radius = std::max(sphere.radius, glm::length(glm::dvec3(vertex.position) - sphere.centre));
    return sphere;
}

void set_depths(Geometry& geometry, const glm::dmat4& view) {
    std::vector<double> sums(geometry.primitives.size()), counts(geometry.primitives.size());
    for (const Vertex& vertex : geometry.vertices) {
        sums[vertex.primitive] -= (view * glm::dvec4(vertex.position, 1)).z;
        counts[vertex.primitive] += 1;
    }
    for (std::size_t i = 0; i < geometry.primitives.size(); ++i)
        geometry.primitives[i].depth = static_cast<float>(sums[i] / counts[i]);
}

void look_through(Geometry& geometry, const Camera& camera, const Sphere& bounds, double aspect) {
    const glm::dmat4 view = camera.view();
    geometry.view_projection = glm::mat4(camera.projection(bounds, aspect) * view);
    geometry.camera = camera_json(camera);
    set_depths(geometry, view);
}

}  // namespace sheer
