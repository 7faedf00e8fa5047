// Trees whose crowns are planes of leaves, turned at random and intersecting each other. Sorting treats a plane as a
// whole, so where planes intersect no drawing order is right: that error is what this scene shows.
#include <algorithm>
#include <cmath>

#include "renderer/core/random.h"
#include "renderer/scene/camera.h"
#include "renderer/scene/scene_info.h"
#include "renderer/scene/solids.h"

namespace sheer {

namespace {

using glm::dvec2;
using glm::dvec3;

constexpr double usual_planes = 300;

struct Tree {
    dvec2 place;
    double height;
    dvec3 crown_centre, crown_radii;
    dvec3 tone;
};

/// Trees keep their distance while there is room; `spread` grows with their number.
std::vector<Tree> plant(std::size_t count, double spread, Random& random) {
    std::vector<Tree> trees;
    while (trees.size() < count) {
        dvec2 place(0);
        double apart = 2.2;
        const auto crowded = [&](const Tree& tree) { return glm::length(tree.place - place) < apart; };
        do {
            place = spread * random_in_disc(random);
            apart *= 0.98;
        } while (std::ranges::any_of(trees, crowded));
        Tree tree{.place = place, .height = random.between(1.9, 2.6)};
        tree.crown_radii = dvec3(1, 0.92, 1) * (0.4 * tree.height) * random.between(0.92, 1.08);
        tree.crown_centre = {place.x, tree.height - 0.55 * tree.crown_radii.y, place.y};
        tree.tone = dvec3{random.between(0.95, 1.3), random.between(1.0, 1.25), random.between(0.8, 1.1)};
        trees.push_back(tree);
    }
    return trees;
}

void add_wood(Geometry& geometry, const Tree& tree, Random& random) {
    const dvec3 bark(random.between(0.40, 0.50), 0.33, 0.25);
    const Shade shade = [=](const dvec3&, const dvec3& normal) { return daylight(bark, normal); };
    const double thick = 0.035 * tree.height;
    const dvec3 foot(tree.place.x, 0, tree.place.y);
    const dvec3 fork = glm::mix(foot, tree.crown_centre, 0.75) + random_in_ball(random) * 0.05;
    add_limb(geometry, foot, foot + (fork - foot) * 0.12, 1.9 * thick, 1.15 * thick, shade);
    add_limb(geometry, foot + (fork - foot) * 0.12, fork, 1.15 * thick, 0.7 * thick, shade);
    for (const dvec2& around : circle(4)) {
        const dvec3 outwards(around.x, random.between(0.5, 1.1), around.y);
        const dvec3 tip =
            tree.crown_centre + (glm::normalize(outwards) * 0.6 + random_in_ball(random) * 0.2) * tree.crown_radii;
        const dvec3 start = glm::mix(foot, fork, random.between(0.8, 1));
        add_limb(geometry, start, tip, 0.5 * thick, 0.15 * thick, shade);
    }
}

/// How much light reaches `at` in the crown: little inside it and on its underside.
double openness(const Tree& tree, const dvec3& at) {
    const dvec3 from_centre = (at - tree.crown_centre) / tree.crown_radii;
    return std::clamp(0.42 + 0.42 * glm::length(from_centre) * (0.6 + 0.4 * from_centre.y) + 0.22 * from_centre.y, 0.25,
                      1.1);
}

void add_plane(Geometry& geometry, const Tree& tree, double size, Random& random) {
    const auto primitive = static_cast<std::uint32_t>(geometry.primitives.size());
    const auto first_vertex = static_cast<std::uint32_t>(geometry.vertices.size());
    // Most leaves grow towards the outside of the crown.
    const dvec3 point = random_in_ball(random);
    const double outwards = 0.45 + 0.5 / (0.2 + glm::length(point));
    const dvec3 centre =
        tree.crown_centre + point * std::min(outwards, 0.95 / (glm::length(point) + 1e-9)) * tree.crown_radii;
    const dvec3 normal = random_direction(random);
    const dvec3 right = glm::normalize(glm::cross(normal, random_direction(random) + normal * 1e-3));
    const dvec3 up = glm::cross(normal, right);
    const double half = 0.5 * size * random.between(0.75, 1.25), tone = random.between(0.85, 1.2);
    const dvec3 light = glm::mix(daylight(dvec3(1), normal.y < 0 ? -normal : normal), dvec3(1), 0.35);
    const dvec2 corners[4] = {{-1, 1}, {1, 1}, {1, -1}, {-1, -1}};
    for (const dvec2& corner : corners) {
        const dvec3 at = centre + (right * corner.x + up * corner.y) * half;
        const dvec3 color = tree.tone * light * (1.5 * tone * openness(tree, at));
        geometry.vertices.push_back({glm::vec3(at),
                                     {corner.x < 0 ? 0.0f : 1.0f, corner.y > 0 ? 0.0f : 1.0f},
                                     glm::vec4(glm::vec3(color), 1),
                                     primitive});
    }
    geometry.primitives.push_back({static_cast<std::uint32_t>(geometry.indices.size()), 6, 0, false});
    for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) geometry.indices.push_back(first_vertex + i);
}

/// Grass, darker under the crowns.
Shade meadow(const std::vector<Tree>& trees) {
    return [&trees](const dvec3& at, const dvec3& normal) {
        double light = 1;
        for (const Tree& tree : trees) {
            // The sun is at the upper left in front of the scene, so shadows fall to the right and back.
            const dvec2 from_shadow = (dvec2(at.x, at.z) - tree.place - dvec2(0.35, -0.4)) / tree.crown_radii.x;
            light *= 1 - 0.55 * std::max(0.0, 1 - glm::dot(from_shadow, from_shadow));
        }
        return daylight(dvec3(0.30, 0.40, 0.16), normal) * light;
    };
}

Geometry build_foliage(const nlohmann::json& scene, const ImageSpec& image, AssetReader&) {
    const double aspect = static_cast<double>(image.width_px) / image.height_px;
    const auto tree_count = scene.at("trees").get<std::size_t>(),
               planes = scene.at("planes_per_tree").get<std::size_t>();
    Random random(scene.at("seed").get<std::uint64_t>());
    const double spread = tree_count == 1 ? 0 : 0.95 * std::sqrt(static_cast<double>(tree_count));
    const std::vector<Tree> trees = plant(tree_count, spread, random);
    Geometry geometry;
    add_ground(geometry, spread + 0.85, 0.10, random, meadow(trees));
    for (const Tree& tree : trees) add_wood(geometry, tree, random);
    // If there are fewer planes, they are larger, so that the total area is the same.
    const double size = 0.30 * std::clamp(std::sqrt(usual_planes / static_cast<double>(planes)), 0.4, 2.5);
    for (const Tree& tree : trees)
        for (std::size_t i = 0; i < planes; ++i) add_plane(geometry, tree, size * tree.height / 2.2, random);
    const Sphere bounds = bounding_sphere(geometry.vertices);
    look_through(geometry, read_camera(scene.at("camera"), bounds, {0, 0.22, 1}, aspect), aspect);
    return geometry;
}

}  // namespace

SceneInfo scene_foliage() {
    return {
        .id = "foliage",
        .name = "Foliage",
        .summary = "Trees whose leaves are textured planes that intersect: no sorting order is right.",
        .source = "Sheer",
        .parameters = {Param::integer("trees", "how many trees", "", 3, 1, 64),
                       Param::integer("planes_per_tree", "planes of leaves in a crown; the more, the smaller", "", 300,
                                      1, 5000),
                       Param::integer("seed", "of the random generator", "", 1, 0, 4294967295.0), camera_parameter()},
        .default_shading = shadings::one_texture,
        .check = check_camera,
        .build = build_foliage,
    };
}

}  // namespace sheer
