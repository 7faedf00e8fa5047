#include "tests/unit/glass_model.h"

#include <array>
#include <glm/glm.hpp>

#include "renderer/scene/solids.h"
#include "tests/unit/glb_writer.h"

namespace sheer::test {

namespace {

using nlohmann::json;
using Profile = std::vector<glm::dvec2>;  // radius and height, from the bottom up

constexpr std::size_t sides = 32;

/// Halves every span twice, each time cutting the corners (Chaikin), so that a rough outline becomes a smooth one.
Profile smoothed(Profile profile, int times) {
    for (int time = 0; time < times; ++time) {
        Profile finer = {profile.front()};
        for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
            finer.push_back(glm::mix(profile[i], profile[i + 1], 0.25));
            finer.push_back(glm::mix(profile[i], profile[i + 1], 0.75));
        }
        finer.push_back(profile.back());
        profile = finer;
    }
    return profile;
}

class StillLife {
  public:
    /// Turns `profile` about the y axis.
    json turned(const Profile& profile) {
        std::vector<float> positions, normals;
        std::vector<std::uint16_t> indices;
        const std::vector<glm::dvec2> around = circle(sides);
        for (std::size_t i = 0; i < profile.size(); ++i) {
            const glm::dvec2 along = profile[i + 1 < profile.size() ? i + 1 : i] - profile[i > 0 ? i - 1 : i];
            const glm::dvec2 out = glm::normalize(glm::dvec2(along.y, -along.x));
            for (std::size_t j = 0; j < sides; ++j) {
                add(positions, {profile[i].x * around[j].x, profile[i].y, -profile[i].x * around[j].y});
                add(normals, {out.x * around[j].x, out.y, -out.x * around[j].y});
                if (i + 1 == profile.size()) continue;
                const std::size_t next = (j + 1) % sides;
                for (const std::size_t index : {i * sides + j, i * sides + next, (i + 1) * sides + next, i * sides + j,
                                                (i + 1) * sides + next, (i + 1) * sides + j})
                    indices.push_back(static_cast<std::uint16_t>(index));
            }
        }
        return {{"attributes",
                 {{"POSITION", m_writer.accessor(positions, "VEC3")}, {"NORMAL", m_writer.accessor(normals, "VEC3")}}},
                {"indices", m_writer.accessor(indices, "SCALAR")}};
    }

    /// A disc that faces up, with a picture repeated `repeats` times across it.
    json cloth(double radius, double repeats) {
        std::vector<float> positions = {0, 0, 0}, normals = {0, 1, 0}, uvs = {0, 0};
        std::vector<std::uint16_t> indices;
        for (std::size_t j = 0; j < sides; ++j) {
            const glm::dvec2 point = circle(sides)[j];
            add(positions, {radius * point.x, 0, -radius * point.y});
            add(normals, {0, 1, 0});
            uvs.push_back(static_cast<float>(point.x * repeats / 2));
            uvs.push_back(static_cast<float>(-point.y * repeats / 2));
            for (const std::size_t index : {std::size_t{0}, 1 + j, 1 + (j + 1) % sides})
                indices.push_back(static_cast<std::uint16_t>(index));
        }
        return {{"attributes",
                 {{"POSITION", m_writer.accessor(positions, "VEC3")},
                  {"NORMAL", m_writer.accessor(normals, "VEC3")},
                  {"TEXCOORD_0", m_writer.accessor(uvs, "VEC2")}}},
                {"indices", m_writer.accessor(indices, "SCALAR")}};
    }

    void place(json shape, int material, const std::array<double, 3>& at, double scale = 1) {
        shape["material"] = material;
        const int mesh = m_writer.add("meshes", {{"primitives", {shape}}});
        m_writer.root({{"mesh", mesh}, {"translation", at}, {"scale", {scale, scale, scale}}});
    }

    GlbWriter& writer() { return m_writer; }

  private:
    static void add(std::vector<float>& list, const glm::dvec3& vector) {
        for (int axis = 0; axis < 3; ++axis) list.push_back(static_cast<float>(vector[axis]));
    }

    GlbWriter m_writer;
};

/// A picture of threads around a hole, with a knot in its middle.
std::string lace() {
    constexpr int size = 32;
    std::vector<std::uint8_t> rgba;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const glm::dvec2 at = (glm::dvec2(x, y) + 0.5) / double(size) - 0.5;
            const double square = glm::dot(at, at);
            const bool hole = square < 0.16 && square > 0.02;
            for (const int channel : {235, 228, 210, hole ? 0 : 255})
                rgba.push_back(static_cast<std::uint8_t>(channel));
        }
    return make_png(size, size, rgba);
}

}  // namespace

std::string make_glass_model() {
    StillLife life;
    GlbWriter& writer = life.writer();
    const int wood = writer.material("OPAQUE", {0.22, 0.09, 0.035, 1}),
              orange = writer.material("OPAQUE", {0.9, 0.25, 0.02, 1}),
              lemon = writer.material("OPAQUE", {0.9, 0.7, 0.08, 1}),
              linen = writer.material("MASK", {1, 1, 1, 1}, writer.texture(lace())),
              green = writer.material("BLEND", {0.03, 0.30, 0.08, 0.45}),
              blue = writer.material("BLEND", {0.05, 0.18, 0.75, 0.4}),
              amber = writer.material("BLEND", {0.85, 0.33, 0.03, 0.4}),
              clear = writer.material("BLEND", {0.75, 0.85, 0.9, 0.22}),
              wine = writer.material("BLEND", {0.25, 0.005, 0.03, 0.8}),
              water = writer.material("BLEND", {0.1, 0.35, 0.5, 0.35});

    life.place(life.turned({{0.01, -0.2}, {1.9, -0.2}, {2.0, -0.16}, {2.0, -0.04}, {1.95, 0}, {0.01, 0}}), wood,
               {0, 0, 0});
    life.place(life.cloth(1.5, 14), linen, {0, 0.01, 0});
    const json ball = life.turned(smoothed({{0.01, -1}, {0.6, -1}, {1, -0.5}, {1, 0.5}, {0.6, 1}, {0.01, 1}}, 1));
    life.place(ball, orange, {0.15, 0.27, -0.75}, 0.25);
    life.place(ball, lemon, {0.62, 0.23, -0.95}, 0.21);

    const json bottle = life.turned(
        smoothed({{0.01, 0.02}, {0.3, 0.02}, {0.31, 0.3}, {0.31, 1.15}, {0.1, 1.45}, {0.1, 1.95}, {0.12, 2.0}}, 1));
    life.place(bottle, green, {-0.72, 0, -0.25});
    life.place(bottle, blue, {0.85, 0, -0.3}, 0.72);
    life.place(life.turned({{0.01, 0.05}, {0.27, 0.05}, {0.28, 0.3}, {0.28, 0.85}, {0.01, 0.85}}), wine,
               {-0.72, 0, -0.25});
    life.place(life.turned(smoothed(
                   {{0.01, 0.02}, {0.25, 0.02}, {0.36, 0.25}, {0.3, 0.5}, {0.09, 0.62}, {0.08, 0.85}, {0.12, 0.9}}, 1)),
               amber, {0.45, 0, 0.5});
    life.place(life.turned(smoothed({{0.01, 0.02}, {0.2, 0.02}, {0.24, 0.4}, {0.26, 0.7}}, 1)), clear, {-0.3, 0, 0.7});
    life.place(life.turned({{0.01, 0.04}, {0.19, 0.04}, {0.21, 0.4}, {0.01, 0.4}}), water, {-0.3, 0, 0.7});
    for (json& material : writer.document["materials"]) material["doubleSided"] = true;
    return writer.glb();
}

}  // namespace sheer::test
