#include "renderer/scene/solids.h"

#include <algorithm>
#include <cmath>

namespace sheer {

namespace {

using glm::dvec2;
using glm::dvec3;

constexpr std::size_t limb_sides = 16;

/// Collects one opaque primitive.
class Solid {
  public:
    explicit Solid(Geometry& geometry)
        : m_geometry(geometry), m_primitive(static_cast<std::uint32_t>(geometry.primitives.size())) {
        geometry.primitives.push_back({static_cast<std::uint32_t>(geometry.indices.size()), 0, 0, true});
    }

    std::uint32_t vertex(const dvec3& position, const dvec3& color) {
        const glm::vec4 tint(glm::vec3(glm::clamp(color, 0.0, 1.0)), 1);
        m_geometry.vertices.push_back({glm::vec3(position), untextured_uv, tint, m_primitive});
        return static_cast<std::uint32_t>(m_geometry.vertices.size() - 1);
    }

    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        for (const std::uint32_t corner : {a, b, c}) m_geometry.indices.push_back(corner);
        m_geometry.primitives[m_primitive].index_count += 3;
    }

    /// Two rings of as many vertices, joined all the way round.
    void band(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
        for (std::size_t i = 0; i < a.size(); ++i) {
            const std::size_t next = (i + 1) % a.size();
            triangle(a[i], a[next], b[next]);
            triangle(a[i], b[next], b[i]);
        }
    }

    void fan(std::uint32_t middle, const std::vector<std::uint32_t>& ring) {
        for (std::size_t i = 0; i < ring.size(); ++i) triangle(middle, ring[i], ring[(i + 1) % ring.size()]);
    }

  private:
    Geometry& m_geometry;
    std::uint32_t m_primitive;
};

/// Two unit vectors at right angles to the unit vector `axis` and to each other.
std::pair<dvec3, dvec3> across(const dvec3& axis) {
    const dvec3 other = std::abs(axis.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0);
    const dvec3 first = glm::normalize(glm::cross(axis, other));
    return {first, glm::cross(axis, first)};
}

}  // namespace

dvec3 daylight(const dvec3& color, const dvec3& normal) {
    static const dvec3 sun = glm::normalize(dvec3(-0.5, 0.8, 0.55));
    const double direct = std::max(glm::dot(normal, sun), 0.0), sky = 0.5 + 0.5 * normal.y;
    return color * (dvec3(0.20, 0.22, 0.26) + sky * dvec3(0.18, 0.21, 0.26) + direct * dvec3(0.80, 0.75, 0.62));
}

void add_ground(Geometry& geometry, double radius, double roughness, Random& random, const Shade& shade) {
    constexpr int rings = 24;
    const dvec3 up(0, 1, 0);
    Solid solid(geometry);
    const auto tint = [&](const dvec3& at) { return shade(at, up) * random.between(1 - roughness, 1 + roughness); };
    const std::uint32_t middle = solid.vertex(dvec3(0), tint(dvec3(0)));
    std::vector<std::uint32_t> inner;
    for (int i = 1; i <= rings; ++i) {
        std::vector<std::uint32_t> ring;
        for (const dvec2& point : circle(64)) {
            const dvec3 at = dvec3(point.x, 0, point.y) * (radius * i / rings);
            ring.push_back(solid.vertex(at, tint(at)));
        }
        if (i == 1) {
            solid.fan(middle, ring);
        } else {
            solid.band(inner, ring);
        }
        inner = ring;
    }
}

void add_limb(Geometry& geometry, const dvec3& from, const dvec3& to, double from_radius, double to_radius,
              const Shade& shade) {
    constexpr int segments = 6;
    const dvec3 axis = glm::normalize(to - from);
    const auto [first, second] = across(axis);
    Solid solid(geometry);
    std::vector<std::uint32_t> last;
    for (int i = 0; i <= segments; ++i) {
        const double along = static_cast<double>(i) / segments;
        std::vector<std::uint32_t> ring;
        for (const dvec2& point : circle(limb_sides)) {
            const dvec3 normal = first * point.x + second * point.y;
            const dvec3 at = glm::mix(from, to, along) + normal * glm::mix(from_radius, to_radius, along);
            ring.push_back(solid.vertex(at, shade(at, normal)));
        }
        if (i > 0) solid.band(last, ring);
        last = ring;
    }
    for (const bool end : {false, true}) {
        const dvec3 middle = end ? to : from, normal = end ? axis : -axis;
        std::vector<std::uint32_t> ring;
        for (const dvec2& point : circle(limb_sides)) {
            const dvec3 at = middle + (first * point.x + second * point.y) * (end ? to_radius : from_radius);
            ring.push_back(solid.vertex(at, shade(at, normal)));
        }
        solid.fan(solid.vertex(middle, shade(middle, normal)), ring);
    }
}

void add_boulder(Geometry& geometry, const dvec3& centre, const dvec3& radii, const Shade& shade) {
    const std::vector<dvec2> around = circle(limb_sides);
    Solid solid(geometry);
    const auto vertex = [&](const dvec3& unit) {
        return solid.vertex(centre + unit * radii, shade(centre + unit * radii, glm::normalize(unit / radii)));
    };
    std::vector<std::uint32_t> last;
    for (std::size_t i = 1; i < limb_sides / 2; ++i) {
        std::vector<std::uint32_t> ring;
        for (const dvec2& point : around)
            ring.push_back(vertex({point.x * around[i].y, around[i].x, point.y * around[i].y}));
        if (i == 1) {
            solid.fan(vertex({0, 1, 0}), ring);
        } else {
            solid.band(last, ring);
        }
        last = ring;
    }
    solid.fan(vertex({0, -1, 0}), last);
}

std::vector<dvec2> circle(std::size_t count) {
    std::vector<dvec2> points = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    while (points.size() < count) {
        std::vector<dvec2> finer;
        for (std::size_t i = 0; i < points.size(); ++i) {
            finer.push_back(points[i]);
            finer.push_back(glm::normalize(points[i] + points[(i + 1) % points.size()]));
        }
        points = finer;
    }
    return points;
}

dvec2 random_in_disc(Random& random) {
    while (true) {
        const double x = random.between(-1, 1), y = random.between(-1, 1);
        if (x * x + y * y <= 1) return {x, y};
    }
}

dvec3 random_in_ball(Random& random) {
    while (true) {
        const double x = random.between(-1, 1), y = random.between(-1, 1), z = random.between(-1, 1);
        if (x * x + y * y + z * z <= 1) return {x, y, z};
    }
}

dvec3 random_direction(Random& random) {
    while (true) {
        const dvec3 point = random_in_ball(random);
        if (glm::dot(point, point) > 0.01) return glm::normalize(point);
    }
}

}  // namespace sheer
