#pragma once
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "renderer/core/random.h"
#include "renderer/scene/scene_info.h"

namespace sheer {

/// Opaque shapes for 3D scenes. Each is one primitive without a texture; its light is baked into the vertices' tints.
/// Only additions, multiplications, divisions and square roots are used, so that they are the same on every platform.

/// The color (0..1) of a surface at `position` that faces along the unit vector `normal`.
using Shade = std::function<glm::dvec3(const glm::dvec3& position, const glm::dvec3& normal)>;

/// Daylight from the upper left in front of the scene, and a sky that lights surfaces facing up.
glm::dvec3 daylight(const glm::dvec3& color, const glm::dvec3& normal);

/// A disc on the plane y = 0 around the origin; `roughness` (a fraction of the shading) varies the vertices' tints.
void add_ground(Geometry& geometry, double radius, double roughness, Random& random, const Shade& shade);

/// A trunk, branch or log: a cone without its tip, closed at both ends.
void add_limb(Geometry& geometry, const glm::dvec3& from, const glm::dvec3& to, double from_radius, double to_radius,
              const Shade& shade);

/// A ball squeezed to `radii` along the axes.
void add_boulder(Geometry& geometry, const glm::dvec3& centre, const glm::dvec3& radii, const Shade& shade);

/// `count` points on the unit circle, evenly spread; a power of two from 4.
std::vector<glm::dvec2> circle(std::size_t count);
/// Uniformly distributed over all directions.
glm::dvec3 random_direction(Random& random);
/// Uniformly distributed over the unit disc.
glm::dvec2 random_in_disc(Random& random);
/// Uniformly distributed over the unit ball.
glm::dvec3 random_in_ball(Random& random);

}  // namespace sheer
