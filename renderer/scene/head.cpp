// The head is made of signed distances to ellipsoids and tapered capsules, joined smoothly (as in Quilez, "Distance
// functions", iquilezles.org). Lengths: 1 is half of the height of the box; x to the head's left, y up, z ahead; the
// head is symmetric, so only x >= 0 is worked out. Only + - * / and square roots are used, so that it is the same on
// every platform.
#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/core/work_queue.h"
#include "renderer/scene/volume.h"

namespace sheer {

namespace {

using glm::vec3;

constexpr vec3 half_sides{0.68f, 1, 0.82f};
constexpr float box_middle_z = 0.04f;
constexpr int block_size = 4;

float length(const vec3& v) {
    return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

float ball(const vec3& p, const vec3& centre, float radius) {
    return length(p - centre) - radius;
}

float ellipsoid(const vec3& p, const vec3& centre, const vec3& radii) {
    const vec3 scaled = (p - centre) / radii;
    const float slope = length(scaled / radii);
    const float out = length(scaled);
    return slope < 1e-4f ? -std::min({radii.x, radii.y, radii.z}) : out * (out - 1) / slope;
}

/// From a ball of radius `ra` to one of `rb`.
float capsule(const vec3& p, const vec3& a, const vec3& b, float ra, float rb) {
    const vec3 pa = p - a, ba = b - a;
    const float along = std::clamp(glm::dot(pa, ba) / glm::dot(ba, ba), 0.0f, 1.0f);
    return length(pa - ba * along) - (ra + (rb - ra) * along);
}

/// Union with an edge that is rounded over about `k`.
float join(float a, float b, float k) {
    const float near = std::max(k - std::abs(a - b), 0.0f) / k;
    return std::min(a, b) - near * near * k * 0.25f;
}

float cut(float a, float b, float k) {
    return -join(-a, b, k);
}

/// Value noise of -1..1 with a lattice of 1.
float noise(const vec3& p) {
    const auto at = [](int x, int y, int z) {
        auto hash = static_cast<std::uint32_t>(x) * 0x8da6b343u ^ static_cast<std::uint32_t>(y) * 0xd8163841u ^
                    static_cast<std::uint32_t>(z) * 0xcb1ab31fu;
        hash = (hash ^ (hash >> 15)) * 0x2c1b3c6du;
        hash = (hash ^ (hash >> 12)) * 0x297a2d39u;
        return static_cast<float>((hash ^ (hash >> 15)) & 0xffffu) / 32767.5f - 1;
    };
    const vec3 cell(std::floor(p.x), std::floor(p.y), std::floor(p.z)), f = p - cell, t = f * f * (3.0f - 2.0f * f);
    const auto x = static_cast<int>(cell.x), y = static_cast<int>(cell.y), z = static_cast<int>(cell.z);
    const auto mix = [](float a, float b, float weight) { return a + (b - a) * weight; };
    const auto row = [&](int dy, int dz) { return mix(at(x, y + dy, z + dz), at(x + 1, y + dy, z + dz), t.x); };
    return mix(mix(row(0, 0), row(1, 0), t.y), mix(row(0, 1), row(1, 1), t.y), t.z);
}

const vec3 eye_centre{0.19f, 0.155f, 0.505f};

float face(const vec3& p) {
    float d = ellipsoid(p, {0, 0.36f, -0.05f}, {0.51f, 0.57f, 0.66f});
    d = join(d, ellipsoid(p, {0, 0.0f, 0.20f}, {0.405f, 0.50f, 0.405f}), 0.12f);
    d = join(d, ellipsoid(p, {0.20f, -0.05f, 0.37f}, {0.17f, 0.17f, 0.19f}), 0.1f);
    d = join(d, capsule(p, {0.31f, -0.27f, 0.10f}, {0.10f, -0.45f, 0.44f}, 0.11f, 0.09f), 0.12f);
    d = join(d, ellipsoid(p, {0, -0.47f, 0.50f}, {0.13f, 0.09f, 0.10f}), 0.10f);
    d = join(d, ellipsoid(p, {0, -0.25f, 0.44f}, {0.20f, 0.17f, 0.17f}), 0.10f);
    d = join(d, capsule(p, {0.04f, 0.255f, 0.575f}, {0.26f, 0.27f, 0.47f}, 0.05f, 0.045f), 0.06f);
    // Sockets, the balls in them and two folds for the lids.
    d = cut(d, ball(p, {0.195f, 0.155f, 0.655f}, 0.115f), 0.10f);
    d = join(d, ball(p, eye_centre, 0.088f), 0.02f);
    d = cut(d, capsule(p, {0.11f, 0.135f, 0.575f}, {0.19f, 0.125f, 0.605f}, 0.008f, 0.010f), 0.015f);
    d = cut(d, capsule(p, {0.19f, 0.125f, 0.605f}, {0.275f, 0.14f, 0.555f}, 0.010f, 0.006f), 0.015f);
    // Nose with wings and nostrils.
    d = join(d, capsule(p, {0, 0.20f, 0.585f}, {0, -0.075f, 0.725f}, 0.040f, 0.062f), 0.07f);
    d = join(d, ellipsoid(p, {0.065f, -0.095f, 0.655f}, {0.045f, 0.042f, 0.06f}), 0.03f);
    d = cut(d, ellipsoid(p, {0.036f, -0.135f, 0.69f}, {0.020f, 0.03f, 0.028f}), 0.02f);
    // Lips, the slit between them, and the groove under the lower one.
    d = cut(d, ellipsoid(p, {0, -0.385f, 0.63f}, {0.13f, 0.03f, 0.04f}), 0.06f);
    d = join(d, capsule(p, {0.02f, -0.235f, 0.605f}, {0.125f, -0.262f, 0.545f}, 0.032f, 0.014f), 0.03f);
    d = join(d, capsule(p, {0, -0.300f, 0.600f}, {0.11f, -0.275f, 0.545f}, 0.036f, 0.016f), 0.03f);
    return cut(d, capsule(p, {0, -0.266f, 0.645f}, {0.145f, -0.270f, 0.565f}, 0.009f, 0.006f), 0.015f);
}

float ear(const vec3& p) {
    // Turned outwards, so that the rear edge stands away from the head.
    const vec3 turned(p.x + 0.35f * (p.z + 0.05f), p.y + 0.2f * p.z, p.z);
    float d = ellipsoid(turned, {0.525f, 0.10f, -0.06f}, {0.045f, 0.165f, 0.105f});
    d = join(d, ellipsoid(turned, {0.515f, -0.035f, -0.035f}, {0.03f, 0.055f, 0.045f}), 0.03f);
    d = cut(d, ellipsoid(turned, {0.570f, 0.115f, -0.05f}, {0.04f, 0.115f, 0.068f}), 0.02f);
    d = join(d, ellipsoid(turned, {0.545f, 0.10f, -0.055f}, {0.02f, 0.075f, 0.030f}), 0.02f);
    return cut(d, ellipsoid(turned, {0.56f, 0.06f, -0.02f}, {0.04f, 0.035f, 0.028f}), 0.015f);
}

float neck(const vec3& p) {
    const vec3 narrow(p.x * 1.05f, p.y, p.z * 0.95f);
    float d = capsule(narrow, {0, -0.25f, -0.15f}, {0, -1.2f, -0.19f}, 0.27f, 0.31f);
    d = join(d, capsule(p, {0.37f, -0.02f, -0.12f}, {0.06f, -1.1f, 0.11f}, 0.07f, 0.05f), 0.10f);
    return join(d, ellipsoid(p, {0, -0.70f, 0.12f}, {0.05f, 0.08f, 0.05f}), 0.10f);
}

float skin(const vec3& p) {
    return join(join(face(p), ear(p), 0.04f), neck(p), 0.10f);
}

float brain_case(const vec3& p) {
    return ellipsoid(p, {0, 0.36f, -0.05f}, {0.425f, 0.485f, 0.575f});
}

float mandible(const vec3& p) {
    const vec3 tall(p.x, p.y * 0.72f, p.z);
    float d = capsule(tall, {0.335f, -0.205f, 0.06f}, {0.20f, -0.285f, 0.36f}, 0.04f, 0.045f);
    d = join(d, capsule(tall, {0.20f, -0.285f, 0.36f}, {0.05f, -0.295f, 0.475f}, 0.045f, 0.045f), 0.05f);
    d = join(d, ellipsoid(p, {0.03f, -0.455f, 0.495f}, {0.075f, 0.05f, 0.05f}), 0.04f);
    const vec3 flat(p.x * 1.5f, p.y, p.z);
    d = join(d, capsule(flat, {0.515f, -0.27f, 0.09f}, {0.57f, -0.03f, 0.03f}, 0.075f, 0.045f), 0.05f);
    return join(d, capsule(flat, {0.53f, -0.15f, 0.13f}, {0.56f, 0.02f, 0.17f}, 0.06f, 0.025f), 0.04f);
}

float facial_bones(const vec3& p) {
    float d = ellipsoid(p, {0, 0.05f, 0.33f}, {0.29f, 0.26f, 0.20f});
    d = join(d, capsule(p, {0.04f, 0.245f, 0.525f}, {0.26f, 0.245f, 0.43f}, 0.045f, 0.045f), 0.05f);
    d = join(d, capsule(p, {0.28f, 0.23f, 0.43f}, {0.31f, 0.05f, 0.38f}, 0.035f, 0.045f), 0.03f);
    d = join(d, ellipsoid(p, {0.27f, 0.0f, 0.41f}, {0.095f, 0.065f, 0.075f}), 0.05f);
    d = join(d, ellipsoid(p, {0, -0.13f, 0.40f}, {0.17f, 0.10f, 0.155f}), 0.06f);
    d = join(d, capsule(p, {0.02f, 0.20f, 0.54f}, {0.035f, 0.08f, 0.585f}, 0.035f, 0.018f), 0.04f);
    // Sockets, the opening of the nose, the mouth, and the hollows under the cheek bones.
    d = cut(d, capsule(p, {0.205f, 0.15f, 0.58f}, {0.09f, 0.14f, 0.28f}, 0.128f, 0.03f), 0.03f);
    d = cut(d, capsule(p, {0, 0.035f, 0.56f}, {0.022f, -0.055f, 0.52f}, 0.035f, 0.055f), 0.02f);
    d = cut(d, ellipsoid(p, {0.045f, -0.01f, 0.42f}, {0.035f, 0.09f, 0.12f}), 0.02f);
    d = cut(d, ellipsoid(p, {0, -0.25f, 0.33f}, {0.125f, 0.09f, 0.17f}), 0.03f);
    d = cut(d, ellipsoid(p, {0.26f, -0.13f, 0.36f}, {0.075f, 0.085f, 0.15f}), 0.03f);
    // The arch from cheek to temple is separate from the skull.
    const float arch = join(capsule(p, {0.31f, 0.0f, 0.38f}, {0.435f, 0.02f, 0.20f}, 0.035f, 0.025f),
                            capsule(p, {0.435f, 0.02f, 0.20f}, {0.43f, 0.06f, 0.02f}, 0.025f, 0.03f), 0.03f);
    return join(d, arch, 0.03f);
}

float spine(const vec3& p) {
    float d = 1;
    for (int i = 0; i < 7; ++i) {
        const float y = -0.26f - 0.125f * static_cast<float>(i), z = -0.15f - 0.012f * static_cast<float>(i);
        if (std::abs(p.y - y) > 0.3f) continue;
        float vertebra = ellipsoid(p, {0, y, z}, {0.095f, 0.055f, 0.08f});
        vertebra =
            join(vertebra, capsule(p, {0.06f, y, z - 0.03f}, {0.155f, y - 0.015f, z - 0.03f}, 0.03f, 0.025f), 0.03f);
        vertebra = join(vertebra, capsule(p, {0.02f, y, z - 0.09f}, {0, y - 0.06f, z - 0.22f}, 0.03f, 0.02f), 0.04f);
        d = std::min(d, vertebra);
    }
    return d;
}

float bones(const vec3& p) {
    float d = ellipsoid(p, {0, 0.36f, -0.05f}, {0.468f, 0.528f, 0.618f});
    // The temples are flat.
    d = cut(d, ball(p, {1.33f, 0.13f, 0.30f}, 0.895f), 0.08f);
    d = join(d, facial_bones(p), 0.05f);
    d = join(d, ellipsoid(p, {0.36f, -0.06f, -0.10f}, {0.06f, 0.12f, 0.08f}), 0.05f);
    return std::min({d, mandible(p), spine(p)});
}

float teeth(const vec3& p) {
    // Half of a row; the lower one stands a little behind the upper.
    struct Tooth {
        float x, z, half_width, half_height;
    };
    constexpr std::array<Tooth, 7> row = {{{0.023f, 0.548f, 0.022f, 0.055f},
                                           {0.064f, 0.534f, 0.019f, 0.050f},
                                           {0.099f, 0.508f, 0.018f, 0.058f},
                                           {0.125f, 0.470f, 0.019f, 0.050f},
                                           {0.143f, 0.428f, 0.021f, 0.047f},
                                           {0.155f, 0.380f, 0.025f, 0.045f},
                                           {0.161f, 0.328f, 0.025f, 0.043f}}};
    const float far = ellipsoid(p, {0, -0.275f, 0.42f}, {0.25f, 0.2f, 0.25f});
    if (far > 0.1f) return far;
    float d = 1;
    for (const Tooth& tooth : row) {
        const float width = tooth.half_width;
        d = std::min(d, ellipsoid(p, {tooth.x, -0.218f, tooth.z}, {width, tooth.half_height, width}));
        d = std::min(d, ellipsoid(p, {tooth.x * 0.93f, -0.325f, tooth.z - 0.018f},
                                  {width * 0.93f, tooth.half_height, width * 0.93f}));
    }
    return d;
}

float brain(const vec3& p) {
    float cerebrum = ellipsoid(p, {0.0f, 0.385f, -0.05f}, {0.385f, 0.435f, 0.535f});
    cerebrum = cut(cerebrum, ellipsoid(p, {0, -0.10f, 0.0f}, {0.40f, 0.19f, 0.65f}), 0.08f);
    if (std::abs(cerebrum) < 0.1f) {
        // Folds: there is a furrow where warped noise passes through 0.
        const vec3 warp(noise(p * 5.0f), noise(p * 5.0f + 17.0f), noise(p * 5.0f + 41.0f));
        const float furrow = std::abs(noise(p * 10.0f + warp));
        cerebrum += 0.05f * std::max(0.0f, 1 - 3.5f * furrow);
    }
    cerebrum = cut(cerebrum, ellipsoid(p, {0, 0.55f, -0.05f}, {0.018f, 0.40f, 0.8f}), 0.03f);
    float cerebellum = ellipsoid(p, {0.12f, 0.03f, -0.33f}, {0.17f, 0.11f, 0.16f});
    const float leaf = p.y * 28 - std::floor(p.y * 28);
    cerebellum += 0.02f * std::abs(2 * leaf - 1);
    const float stem = capsule(p, {0, 0.12f, -0.12f}, {0, -1.2f, -0.30f}, 0.06f, 0.03f);
    return std::min(std::max(std::min(cerebrum, cerebellum), brain_case(p) + 0.02f), stem);
}

float airways(const vec3& p) {
    float d = ellipsoid(p, {0.042f, -0.01f, 0.42f}, {0.024f, 0.07f, 0.17f});
    d = join(d, capsule(p, {0.036f, -0.12f, 0.69f}, {0.036f, -0.05f, 0.55f}, 0.014f, 0.02f), 0.03f);
    d = join(d, capsule(p, {0, -0.03f, 0.26f}, {0, -0.35f, 0.10f}, 0.03f, 0.05f), 0.03f);
    return join(d, capsule(p, {0, -0.35f, 0.10f}, {0, -1.2f, 0.03f}, 0.05f, 0.055f), 0.03f);
}

float eye(const vec3& p) {
    return ball(p, eye_centre, 0.074f);
}

struct Part {
    float (*distance)(const vec3& p);
};
constexpr std::array parts = {skin, bones, brain_case, brain, eye, teeth, airways};
using Distances = std::array<float, parts.size()>;

class Head {
  public:
    explicit Head(int size)
        : m_size(size),
          m_step(half_sides * (2.0f / static_cast<float>(size))),
          m_edge(1.2f * m_step.y),
          m_skin_thickness(std::max(0.028f, 2.4f * m_step.y)) {
        m_volume.size = glm::ivec3(size);
        m_volume.spacing = half_sides;
        m_volume.bytes.resize(m_volume.voxel_count());
    }

    Volume make() {
        const int rows = (m_size + block_size - 1) / block_size;
        share_work(rows, [&](WorkQueue& queue) {
            for (int row = 0; queue.take(row);) fill_row(row * block_size);
        });
        return std::move(m_volume);
    }

  private:
    vec3 position(const vec3& voxel) const {
        const vec3 from_middle = voxel + 0.5f - 0.5f * static_cast<float>(m_size);
        return from_middle * m_step + vec3(0, 0, box_middle_z);
    }

    /// 1 inside the surface, 0 outside, with an edge of two or three voxels.
    float inside(float distance) const { return std::clamp(0.5f - distance / (2 * m_edge), 0.0f, 1.0f); }

    float value(const Distances& d) const {
        const auto [d_skin, d_bones, d_case, d_brain, d_eye, d_teeth, d_air] = d;
        float value = HeadValues::air;
        const auto fill = [&](float material, float distance) { value += (material - value) * inside(distance); };
        fill(HeadValues::skin, d_skin);
        fill(HeadValues::flesh, d_skin + m_skin_thickness);
        fill(HeadValues::eye, d_eye);
        fill(HeadValues::bone, d_bones);
        fill(HeadValues::flesh, d_case);
        fill(HeadValues::brain, d_brain);
        fill(HeadValues::tooth, d_teeth);
        fill(HeadValues::air, d_air);
        return value;
    }

    void fill_row(int z) {
        for (int y = 0; y < m_size; y += block_size)
            for (int x = (m_size / 2) / block_size * block_size; x < m_size; x += block_size) fill_block({x, y, z});
    }

    /// If the surface of a part is not near the block, its distance from the block's middle stands for the whole block.
    void fill_block(const glm::ivec3& from) {
        const vec3 middle = position(vec3(from) + 0.5f * (block_size - 1));
        const float reach = 0.75f * block_size * length(m_step) + 2 * m_edge + m_skin_thickness;
        Distances distances;
        std::array<bool, parts.size()> near{};
        for (std::size_t i = 0; i < parts.size(); ++i) {
            distances[i] = parts[i](vec3(std::abs(middle.x), middle.y, middle.z));
            near[i] = std::abs(distances[i]) < reach;
        }
        const glm::ivec3 end = glm::min(from + block_size, glm::ivec3(m_size));
        for (int z = from.z; z < end.z; ++z)
            for (int y = from.y; y < end.y; ++y)
                for (int x = from.x; x < end.x; ++x) {
                    const vec3 at = position(vec3(x, y, z));
                    const vec3 p(std::abs(at.x), at.y, at.z);
                    for (std::size_t i = 0; i < parts.size(); ++i)
                        if (near[i]) distances[i] = parts[i](p);
                    set(x, y, z, value(distances));
                }
    }

    void set(int x, int y, int z, float value) {
        const std::size_t row = (static_cast<std::size_t>(z) * m_size + y) * m_size;
        m_volume.bytes[row + x] = m_volume.bytes[row + (m_size - 1 - x)] =
            static_cast<std::uint8_t>(value * 255 + 0.5f);
    }

    int m_size;
    vec3 m_step;  ///< from voxel to voxel
    float m_edge, m_skin_thickness;
    Volume m_volume;
};

}  // namespace

Volume make_head(int size) {
    return Head(size).make();
}

}  // namespace sheer
