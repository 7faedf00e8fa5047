// Sprites of fire and smoke that rise from a fireplace. They face the camera, so each has one depth and none cuts
// another: drawing them in the order of their depths is exact. Vertices are in camera space, where a sprite's corners
// have the same z to the last bit.
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

constexpr double ground_radius = 1.7, plume_height = 3.45, flame_height = 1.3, flame_share = 0.4;
constexpr double usual_count = 2000;

/// Holds ground and plume, whatever the seed and the count, at size 1.
const Sphere fire_bounds{{0.15, 1.95, 0}, 2.8};

struct Sprite {
    dvec3 centre;
    double radius;
    glm::vec4 tint;
};

/// Between -1 and 1 with period 1, made of parabolas.
double wave(double x) {
    const double phase = x - std::floor(x), half = 2 * phase - (phase < 0.5 ? 0 : 1);
    return (phase < 0.5 ? 4 : -4) * half * (1 - half);
}

/// Smoke is made of billows and fire of tongues, so that the plume keeps its shape however many sprites there are.
class Plume {
  public:
    Plume(bool fire, Random& random) : m_fire(fire) {
        for (int i = 0; i < 56; ++i) m_billows.push_back(billow((i + random.unit()) / 56, random));
        for (int i = 0; i < 28; ++i) {
            const dvec2 foot = random_in_disc(random);
            const double height = random.between(0.55, 1.0) * (1.15 - 0.5 * glm::length(foot));
            m_tongues.push_back({0.34 * foot, flame_height * height});
        }
    }

    Sprite sprite(Random& random) const {
        const double share = random.unit();
        return m_fire && share < flame_share ? flame(m_tongues[random.below(m_tongues.size())], random)
                                             : smoke(m_billows[random.below(m_billows.size())], random);
    }

  private:
    struct Billow {
        dvec3 centre;
        double age, radius;
    };
    struct Tongue {
        dvec2 foot;
        double height;
    };

    /// Billows grow and drift as they rise.
    Billow billow(double age, Random& random) const {
        const double low = m_fire ? 0.8 : 0.2;
        const dvec2 drift(0.55 * age * age + 0.13 * wave(1.4 * age), 0.10 * wave(1.1 * age + 0.3));
        const dvec2 place = drift + random_in_disc(random) * (0.05 + 0.30 * age);
        return {{place.x, low + (plume_height - low) * age, place.y}, age, 0.10 + 0.22 * age};
    }

    /// Fades as it rises; lit from the upper left, and from below if there is a fire.
    Sprite smoke(const Billow& billow, Random& random) const {
        const dvec3 place = random_in_ball(random);
        const double age = billow.age;
        const double tone = random.between(0.85, 1.1) * (0.82 - 0.26 * place.x + 0.24 * place.y + 0.12 * place.z);
        const dvec3 grey = glm::mix(dvec3(0.46, 0.46, 0.48), dvec3(0.90, 0.92, 0.97), age) * tone;
        const double glow = m_fire ? std::max(0.0, 1 - 2.6 * age) : 0;
        const dvec3 color = grey + glow * glow * dvec3(0.85, 0.30, 0.04);
        const double alpha = 0.5 * (1 - age) * std::min(1.0, 0.15 + 6 * age);
        return {billow.centre + place * billow.radius,
                random.between(0.8, 1.1) * (0.16 + 0.24 * age),
                {glm::vec3(color), static_cast<float>(alpha)}};
    }

    /// White-hot at the foot, red at the tips. Colors exceed 1 because the texture is a grey cloud.
    Sprite flame(const Tongue& tongue, Random& random) const {
        const double age = random.unit();
        const dvec2 lean = dvec2(0.07 * wave(1.3 * age + 0.25) * age, 0);
        const dvec2 across = tongue.foot * (1 - 0.75 * age) + lean + random_in_disc(random) * (0.14 * (1 - age) + 0.02);
        const double height = tongue.height * age, heat = std::min(1.0, height / flame_height + 0.25 * age);
        const dvec3 young(2.0, 1.45, 0.62), middle(1.8, 0.76, 0.12), old(0.9, 0.18, 0.04);
        const dvec3 color =
            heat < 0.35 ? glm::mix(young, middle, heat / 0.35) : glm::mix(middle, old, (heat - 0.35) / 0.65);
        return {{across.x, 0.08 + height, across.y},
                random.between(0.15, 0.24) * (1 - 0.6 * age),
                {glm::vec3(color), static_cast<float>(0.7 * (1 - age * age))}};
    }

    bool m_fire;
    std::vector<Billow> m_billows;
    std::vector<Tongue> m_tongues;
};

/// The more sprites there are, the smaller and fainter they are, so that a million of them give a finer grain and not a
/// wall: the size falls with about the cube root of the count, and the product of count, area and alpha is constant.
struct Grain {
    double size, alpha;
};
Grain grain_of(double count) {
    const double fourth_root = std::sqrt(std::sqrt(usual_count / count));
    return {std::min(1.1, fourth_root * std::sqrt(fourth_root)), std::min(1.3, fourth_root)};
}

void add_sprite(Geometry& geometry, const Sprite& sprite, const glm::dmat4& view, Random& random) {
    const auto primitive = static_cast<std::uint32_t>(geometry.primitives.size());
    const auto first_vertex = static_cast<std::uint32_t>(geometry.vertices.size());
    const dvec3 centre(view * glm::dvec4(sprite.centre, 1));
    // A turn by its rational parametrisation; the diagonal of the square is twice the radius.
    const double t = random.between(-1, 1);
    const dvec2 axis = dvec2(1 - t * t, 2 * t) / (1 + t * t) * (sprite.radius * (random.below(2) == 0 ? 1 : -1));
    const dvec2 corners[4] = {axis, {-axis.y, axis.x}, -axis, {axis.y, -axis.x}};
    const glm::vec2 uvs[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (int i = 0; i < 4; ++i) {
        const glm::vec3 at(glm::vec2(dvec2(centre) + corners[i]), static_cast<float>(centre.z));
        geometry.vertices.push_back({at, uvs[i], sprite.tint, primitive});
    }
    geometry.primitives.push_back({static_cast<std::uint32_t>(geometry.indices.size()), 6, 0, false});
    for (const std::uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) geometry.indices.push_back(first_vertex + corner);
}

/// Night with a fire in the middle, or daylight without one.
Shade light_of(const dvec3& color, bool fire) {
    return [=](const dvec3& at, const dvec3& normal) {
        if (!fire) return daylight(color, normal);
        const dvec3 to_fire = dvec3(0, 0.55, 0) - at;
        const double distance = glm::length(to_fire);
        const double facing = std::max(glm::dot(normal, to_fire) / (distance + 1e-9), 0.0);
        const double sky = 0.5 + 0.5 * normal.y;
        return color * (dvec3(0.10, 0.12, 0.18) + sky * dvec3(0.10, 0.12, 0.18) +
                        (0.15 + facing) / (0.25 + 1.3 * distance * distance) * dvec3(2.2, 1.05, 0.36));
    };
}

/// Ground, a ring of stones and logs that lean against each other.
void add_fireplace(Geometry& geometry, bool fire, Random& random) {
    add_ground(geometry, ground_radius, 0.12, random, light_of({0.36, 0.31, 0.25}, fire));
    for (const dvec2& around : circle(16)) {
        const double size = random.between(0.095, 0.14), out = random.between(0.66, 0.72);
        const double grey = random.between(0.38, 0.55);
        add_boulder(geometry, {around.x * out, 0.6 * size, around.y * out}, dvec3(1.15, 0.85, 1.0) * size,
                    light_of({grey, 0.97 * grey, 0.93 * grey}, fire));
    }
    for (const dvec2& around : circle(8)) {
        const dvec3 side(-around.y, 0, around.x);
        const double out = random.between(0.46, 0.56), height = random.between(0.5, 0.66);
        const double foot_aside = random.between(-0.1, 0.1), top_aside = random.between(-0.06, 0.06);
        const double thick = random.between(0.055, 0.075);
        const dvec3 foot = dvec3(around.x, 0.1, around.y) * out + side * foot_aside;
        const dvec3 top = dvec3(-0.12 * around.x, height, -0.12 * around.y) + side * top_aside;
        add_limb(geometry, foot, top, thick, 0.8 * thick, light_of(dvec3(0.36, 0.24, 0.15), fire));
    }
}

Geometry build_particles(const nlohmann::json& scene, const ImageSpec& image, AssetReader&) {
    const double aspect = static_cast<double>(image.width_px) / image.height_px;
    const bool fire = scene.at("appearance").get<std::string>() == "fire";
    const auto count = scene.at("count").get<std::size_t>();
    const Camera camera = read_camera(scene.at("camera"), fire_bounds, {0, 0.16, 1}, aspect);
    const glm::dmat4 view = camera.view();
    Random random(scene.at("seed").get<std::uint64_t>());
    Geometry geometry;
    add_fireplace(geometry, fire, random);
    for (Vertex& vertex : geometry.vertices)
        vertex.position = glm::vec3(view * glm::dvec4(glm::dvec3(vertex.position), 1));
    geometry.vertices.reserve(geometry.vertices.size() + 4 * count);
    geometry.indices.reserve(geometry.indices.size() + 6 * count);
    geometry.primitives.reserve(geometry.primitives.size() + count);
    const Plume plume(fire, random);
    const Grain grain = grain_of(scene.at("fit_count").get<bool>() ? static_cast<double>(count) : usual_count);
    const auto opacity = scene.at("opacity").get<double>();
    const double size = scene.at("size").get<double>() * grain.size * 1.4142135623730951;
    for (std::size_t i = 0; i < count; ++i) {
        Sprite sprite = plume.sprite(random);
        sprite.radius *= size;
        sprite.tint.a *= static_cast<float>(grain.alpha * opacity);
        add_sprite(geometry, sprite, view, random);
    }
    look_from_camera_space(geometry, camera, aspect);
    geometry.parallel = true;
    return geometry;
}

}  // namespace

SceneInfo scene_particles() {
    return {
        .id = "particles",
        .name = "Particles",
        .summary = "Sprites of fire and smoke that face the camera and rise from a fireplace of logs and stones.",
        .source = "Sheer",
        .parameters =
            {Param::choice("appearance", "fire that turns to smoke, at night; or smoke by day", "fire",
                           {"fire", "smoke"}),
             Param::integer("count", "how many sprites", "", 2000, 1, 1000000),
             Param::boolean(
                 "fit_count",
                 "whether sprites get smaller and fainter the more there are, so that the plume looks the same; "
                 "otherwise each is as large and as opaque as one of 2000",
                 true),
             Param::number("size", "of the sprites, relative to the usual size", "", 1, 0.1, 4),
             Param::number("opacity", "of the sprites, relative to the usual opacity", "", 1, 0, 1),
             Param::integer("seed", "of the random generator", "", 1, 0, 4294967295.0), camera_parameter()},
        .default_shading = shadings::one_texture,
        .default_texture = "smoke",
        .check = check_camera,
        .build = build_particles,
    };
}

}  // namespace sheer
