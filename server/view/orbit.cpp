#include "server/view/orbit.h"

#include <algorithm>
#include <cmath>

#include "renderer/scene/camera.h"

namespace sheer::view {

namespace {

constexpr double highest_deg = 89, farthest = 1e18;
/// Relative to the target's coordinates: any closer, doubles would lose the precision of directions.
constexpr double nearest_ratio = 1e-9;

Camera camera_of(const nlohmann::json& camera) {
    return read_camera(camera, {}, {0, 0, 1}, 1);
}

}  // namespace

nlohmann::json orbited(const nlohmann::json& camera, double turn_rad, double rise_rad) {
    Camera moved = camera_of(camera);
    const glm::dvec3 up = glm::normalize(moved.up), offset = moved.eye - moved.target;
    const double distance = glm::length(offset);
    const glm::dvec3 ahead = glm::normalize(offset - up * glm::dot(offset, up)), side = glm::cross(up, ahead);
    const double limit = glm::radians(highest_deg);
    const double height = std::asin(std::clamp(glm::dot(offset, up) / distance, -1.0, 1.0));
    const double rise = std::clamp(height + rise_rad, -limit, limit);
    const glm::dvec3 around = ahead * std::cos(turn_rad) + side * std::sin(turn_rad);
    moved.eye = moved.target + distance * (around * std::cos(rise) + up * std::sin(rise));
    return camera_json(moved);
}

nlohmann::json moved_away(const nlohmann::json& camera, double factor) {
    Camera moved = camera_of(camera);
    const glm::dvec3 offset = moved.eye - moved.target;
    const double distance = glm::length(offset), nearest = nearest_ratio * std::max(1.0, glm::length(moved.target));
    moved.eye = moved.target + offset * (std::clamp(distance * factor, nearest, farthest) / distance);
    return camera_json(moved);
}

}  // namespace sheer::view
