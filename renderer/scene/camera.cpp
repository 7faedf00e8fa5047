#include "renderer/scene/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

namespace sheer {

namespace {

using glm::dvec3;

constexpr double default_fov_y_deg = 40;
constexpr double any = std::numeric_limits<double>::infinity();
/// The near plane's distance over the far plane's. The depth buffer holds 32-bit floats.
constexpr double least_ratio = 1e-6;
constexpr double least_sine = 1e-6;  // of the angle between `up` and the line of sight

dvec3 vector_of(const nlohmann::json& numbers) {
    const auto values = numbers.get<std::array<double, 3>>();
    return {values[0], values[1], values[2]};
}

double half_height(double fov_y_deg) {
    return std::tan(glm::radians(fov_y_deg) / 2);
}

/// A vector of length 1, however long or short `vector` is; 0 if it is 0.
dvec3 direction_of(const dvec3& vector) {
    const double longest = std::max({std::abs(vector.x), std::abs(vector.y), std::abs(vector.z)});
    return longest > 0 ? glm::normalize(vector / longest) : dvec3(0);
}

/// From `from` to `to`, even if their difference overflows a double.
dvec3 direction_between(const dvec3& from, const dvec3& to) {
    return direction_of(to / 2.0 - from / 2.0);
}

/// The view from the eye: points within it are dot(side, point) <= 0 for all four.
std::array<dvec3, 4> sides_of_view(double fov_y_deg, double aspect) {
    const double height = half_height(fov_y_deg), width = height * aspect;
    return {dvec3(1, 0, width), {-1, 0, width}, {0, 1, height}, {0, -1, height}};
}

/// Keeps the part of the polygon on the inner side. (Sutherland and Hodgman 1974.)
void cut_polygon(std::vector<dvec3>& polygon, const dvec3& side) {
    std::vector<dvec3> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double at_a = glm::dot(side, a), at_b = glm::dot(side, b);
        if (at_a <= 0) kept.push_back(a);
        if ((at_a <= 0) != (at_b <= 0)) kept.push_back(a + (b - a) * (at_a / (at_a - at_b)));
    }
    polygon = std::move(kept);
}

/// The range of distances ahead of the eye that the visible geometry spans.
class ViewDepths {
  public:
    ViewDepths(double fov_y_deg, double aspect) : m_sides(sides_of_view(fov_y_deg, aspect)) {}

    void add(const std::array<dvec3, 3>& corners) {
        std::size_t within = 0;
        for (const dvec3& side : m_sides) {
            const auto outside =
                std::ranges::count_if(corners, [&](const dvec3& at) { return glm::dot(side, at) > 0; });
            if (outside == 3) return;
            within += outside == 0;
        }
        std::vector<dvec3> polygon(corners.begin(), corners.end());
        for (const dvec3& side : m_sides)
            if (within < m_sides.size()) cut_polygon(polygon, side);
        for (const dvec3& at : polygon) {
            m_nearest = std::min(m_nearest, -at.z);
            m_farthest = std::max(m_farthest, -at.z);
        }
    }

    Planes planes() const {
        constexpr double slack = 1e-4;
        if (!(m_farthest > 0) || !std::isfinite(m_farthest)) return {};
        const double far = m_farthest * (1 + slack);
        return {std::max(m_nearest * (1 - slack), far * least_ratio), far};
    }

  private:
    std::array<dvec3, 4> m_sides;
    double m_nearest = any, m_farthest = 0;
};

/// Clip coordinates may all be multiplied by the same number: here by a power of two, so that they fit in floats
/// however large or small the scene is.
glm::mat4 to_float(const glm::dmat4& clip, double far) {
    const int exponent = std::abs(std::ilogb(far)) > 20 ? std::ilogb(far) : 0;
    glm::mat4 matrix;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            matrix[column][row] = static_cast<float>(std::clamp(std::ldexp(clip[column][row], -exponent), -1e30, 1e30));
    return matrix;
}

void finish(Geometry& geometry, const Camera& camera, const glm::dmat4& view, double aspect) {
    const Planes planes = planes_of_view(geometry, view, camera.fov_y_deg, aspect);
    geometry.view_projection = to_float(camera.projection(planes, aspect) * view, planes.far);
    geometry.camera = camera_json(camera);
    set_depths(geometry, view);
}

}  // namespace

glm::dmat4 Camera::view(const dvec3& origin) const {
    const dvec3 ahead = direction_between(eye, target), right = glm::normalize(glm::cross(ahead, direction_of(up))),
                above = glm::cross(right, ahead), from = eye - origin;
    glm::dmat4 view(1);
    for (int axis = 0; axis < 3; ++axis) view[axis] = glm::dvec4(right[axis], above[axis], -ahead[axis], 0);
    view[3] = glm::dvec4(-glm::dot(right, from), -glm::dot(above, from), glm::dot(ahead, from), 1);
    return view;
}

glm::dmat4 Camera::projection(const Planes& planes, double aspect) const {
    return glm::perspectiveRH_ZO(glm::radians(fov_y_deg), aspect, planes.near, planes.far);
}

Param camera_parameter() {
    const std::vector<std::string> axes = {"x", "y", "z"};
    Param camera = Param::object(
        "camera", "where the scene is seen from; without a camera, all of the scene is in the picture",
        {Param::numbers("eye", "where the camera is; y is up", "", {4, 3, 6}, -any, any).of(axes),
         Param::numbers("target", "what is in the middle of the picture", "", {0, 1.5, 0}, -any, any).of(axes),
         Param::numbers("up", "what points up in the picture", "", {0, 1, 0}, -any, any).of(axes),
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
    const dvec3 eye = vector_of(camera.at("eye")), target = vector_of(camera.at("target")),
                up = direction_of(vector_of(camera.at("up"))), sight = direction_between(eye, target);
    if (sight == dvec3(0)) {
        errors.push_back({own + "/target", "must differ from eye"});
    } else if (up == dvec3(0)) {
        errors.push_back({own + "/up", "must have a length"});
    } else if (glm::length(glm::cross(sight, up)) < least_sine) {
        errors.push_back({own + "/up", "must not be parallel to the line from eye to target"});
    }
}

Camera read_camera(const nlohmann::json& camera, const Sphere& bounds, const dvec3& direction, double aspect) {
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
    const auto numbers = [](const dvec3& vector) { return nlohmann::json{vector.x, vector.y, vector.z}; };
    return {{"eye", numbers(camera.eye)},
            {"target", numbers(camera.target)},
            {"up", numbers(camera.up)},
            {"fov_y_deg", camera.fov_y_deg}};
}

Sphere bounding_sphere(const std::vector<Vertex>& vertices) {
    if (vertices.empty()) return {};
    dvec3 low(vertices.front().position), high = low;
    for (const Vertex& vertex : vertices) {
        low = glm::min(low, dvec3(vertex.position));
        high = glm::max(high, dvec3(vertex.position));
    }
    Sphere sphere{(low + high) / 2.0, 0};
    for (const Vertex& vertex : vertices)
        sphere.radius = std::max(sphere.radius, glm::length(dvec3(vertex.position) - sphere.centre));
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

Planes planes_of_view(const Geometry& geometry, const glm::dmat4& view, double fov_y_deg, double aspect) {
    ViewDepths depths(fov_y_deg, aspect);
    const auto seen = [&](std::size_t i) {
        return dvec3(view * glm::dvec4(geometry.vertices[geometry.indices[i]].position, 1));
    };
    for (std::size_t i = 0; i + 2 < geometry.indices.size(); i += 3) depths.add({seen(i), seen(i + 1), seen(i + 2)});
    return depths.planes();
}

void look_through(Geometry& geometry, const Camera& camera, double aspect, const dvec3& origin) {
    finish(geometry, camera, camera.view(origin), aspect);
}

void look_from_camera_space(Geometry& geometry, const Camera& camera, double aspect) {
    finish(geometry, camera, glm::dmat4(1), aspect);
}

}  // namespace sheer
