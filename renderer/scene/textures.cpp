#include "renderer/scene/textures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <stdexcept>

#include "renderer/core/random.h"

namespace sheer {

namespace {

using glm::vec2;
using glm::vec3;
using glm::vec4;

float smooth_step(float low, float high, float x) {
    const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
}

/// Value noise on a lattice that repeats every `period` cells, 0..1.
class Noise {
  public:
    explicit Noise(std::uint64_t seed) {
        Random random(seed);
        for (float& value : m_lattice) value = static_cast<float>(random.unit());
    }

    float at(vec2 p, int period) const {
        const float fx = std::floor(p.x), fy = std::floor(p.y);
        const int x = static_cast<int>(fx), y = static_cast<int>(fy);
        const float u = smooth_step(0, 1, p.x - fx), v = smooth_step(0, 1, p.y - fy);
        const float top = lattice(x, y, period) * (1 - u) + lattice(x + 1, y, period) * u;
        const float bottom = lattice(x, y + 1, period) * (1 - u) + lattice(x + 1, y + 1, period) * u;
        return top * (1 - v) + bottom * v;
    }

    /// Octaves of halving weight, 0..1.
    float fractal(vec2 p, int period, int octaves) const {
        float sum = 0, weight = 0.5f, total = 0;
        for (int i = 0; i < octaves; ++i) {
            sum += weight * at(p * static_cast<float>(period), period);
            total += weight;
            period *= 2;
            weight *= 0.5f;
        }
        return sum / total;
    }

  private:
    static constexpr int lattice_size = 256;
    float lattice(int x, int y, int period) const {
        const int wrapped_x = ((x % period) + period) % period, wrapped_y = ((y % period) + period) % period;
        return m_lattice[static_cast<std::size_t>((wrapped_y * 73 + wrapped_x * 151 + wrapped_x * wrapped_y) %
                                                  lattice_size)];
    }
    float m_lattice[lattice_size];
};

/// One leaf: a lens around a midrib from `base` along `direction`.
struct Leaf {
    vec2 base, direction;
    float length, half_width;
    vec3 color;

    /// Straight color and alpha at `p`; `edge` is the softness of the rim in texture units.
    vec4 at(vec2 p, float edge, const Noise& noise) const {
        const vec2 from_base = p - base;
        const float along = (from_base.x * direction.x + from_base.y * direction.y) / length;
        if (along <= 0 || along >= 1) return vec4(0);
        const float across = from_base.x * direction.y - from_base.y * direction.x;
        // Widest at a third of the length, pointed at the tip.
        const float profile = 6.75f * along * (1 - along) * (1 - along);
        const float serration = 1 - 0.06f * std::abs(2 * (along * 18 - std::floor(along * 18)) - 1);
        const float rim = half_width * std::sqrt(std::max(profile, 0.0f)) * serration;
        const float distance = std::abs(across);
        const float alpha = smooth_step(0, edge, rim - distance);
        if (alpha == 0) return vec4(0);

        const float ribs = along * 9 - distance / half_width * 1.5f;
        const float to_rib = std::abs(ribs - std::floor(ribs) - 0.5f);
        const float vein =
            std::max(1 - distance / (0.05f * half_width + 1e-6f), 0.45f * smooth_step(0.42f, 0.5f, to_rib));
        const float mottle = 0.75f + 0.5f * noise.fractal(p, 16, 3);
        const float shade = mottle * (1.05f - 0.45f * distance / (rim + 1e-6f));
        return vec4(glm::min(color * shade + vec3(0.28f, 0.30f, 0.12f) * std::max(vein, 0.0f), vec3(1)), alpha);
    }
};

std::vector<Leaf> make_leaves(int variant) {
    Random random(0x1eaf + static_cast<std::uint64_t>(variant));
    const vec3 greens[4] = {{0.26f, 0.52f, 0.12f}, {0.45f, 0.58f, 0.14f}, {0.17f, 0.42f, 0.17f}, {0.66f, 0.46f, 0.10f}};
    std::vector<Leaf> leaves;
    for (int i = 0; i < 9; ++i) {
        // A point on the unit circle by its rational parametrisation: no sine, so it is the same on every platform.
        const auto t = static_cast<float>(random.between(-1, 1));
        vec2 direction = vec2(1 - t * t, 2 * t) / (1 + t * t);
        if (i % 2 == 1) direction = -direction;
        if (i % 4 >= 2) direction = vec2(-direction.y, direction.x);
        const auto length = static_cast<float>(random.between(0.45, 0.75));
        const vec2 middle(static_cast<float>(random.between(0.22, 0.78)),
                          static_cast<float>(random.between(0.22, 0.78)));
        const auto tone = static_cast<float>(random.between(0.75, 1.2));
        leaves.push_back({middle - direction * (length / 2), direction, length,
                          length * static_cast<float>(random.between(0.17, 0.26)),
                          greens[(variant + (i % 3 == 2)) % 4] * tone});
    }
    return leaves;
}

/// Paints later leaves over earlier ones (the "over" operator on straight alpha).
vec4 leaf_texel(vec2 p, float texel, const std::vector<Leaf>& leaves, const Noise& noise) {
    const float edge = std::max(0.012f, 2 * texel);
    vec4 under(leaves.front().color, 0);
    for (const Leaf& leaf : leaves) {
        const vec4 over = leaf.at(p, edge, noise);
        if (over.a == 0) continue;
        const float alpha = over.a + under.a * (1 - over.a);
        under = vec4((vec3(over) * over.a + vec3(under) * under.a * (1 - over.a)) / alpha, alpha);
    }
    return under;
}

vec4 smoke_texel(vec2 p, const Noise& noise) {
    const vec2 from_middle = p - vec2(0.5f);
    const vec2 bent = p + 0.12f * vec2(noise.fractal(p, 4, 3) - 0.5f, noise.fractal(vec2(p.y, p.x), 4, 3) - 0.5f);
    const float billow = noise.fractal(bent, 4, 6);
    const float radius = 2 * std::sqrt(from_middle.x * from_middle.x + from_middle.y * from_middle.y);
    const float falloff = smooth_step(1, 0.15f, radius + 1.2f * (0.5f - billow));
    const float density = falloff * smooth_step(0.2f, 0.5f, billow);
    const float light = 0.35f + 0.6f * noise.fractal(bent + vec2(0.05f, 0.08f), 4, 5);
    return vec4(vec3(light) * vec3(1.0f, 0.98f, 0.95f), std::min(0.9f * density, 1.0f));
}

TextureLevel paint(const std::string& image, int size_px, int variant) {
    TextureLevel level{size_px, std::vector<std::uint8_t>(static_cast<std::size_t>(size_px) * size_px * 4)};
    const Noise noise(0x5eed + static_cast<std::uint64_t>(variant));
    const std::vector<Leaf> leaves = make_leaves(variant);
    const float texel = 1.0f / static_cast<float>(size_px);
    std::uint8_t* out = level.rgba.data();
    for (int y = 0; y < size_px; ++y) {
        for (int x = 0; x < size_px; ++x) {
            const vec2 p = (vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5f) * texel;
            const vec4 color = image == "leaf" ? leaf_texel(p, texel, leaves, noise) : smoke_texel(p, noise);
            for (int channel = 0; channel < 4; ++channel)
                *out++ = static_cast<std::uint8_t>(std::clamp(color[channel], 0.0f, 1.0f) * 255 + 0.5f);
        }
    }
    return level;
}

/// Half the size. If all four texels are transparent, their plain mean keeps a color under the alpha of 0.
TextureLevel halved(const TextureLevel& source) {
    const int size = source.size_px / 2;
    TextureLevel level{size, std::vector<std::uint8_t>(static_cast<std::size_t>(size) * size * 4)};
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            unsigned alpha = 0, weighted[3] = {}, plain[3] = {};
            for (int i = 0; i < 4; ++i) {
                const std::size_t row = static_cast<std::size_t>(2 * y + i / 2) * source.size_px;
                const std::uint8_t* texel = &source.rgba[(row + 2 * x + i % 2) * 4];
                alpha += texel[3];
                for (int channel = 0; channel < 3; ++channel) {
                    weighted[channel] += unsigned{texel[channel]} * texel[3];
                    plain[channel] += texel[channel];
                }
            }
            std::uint8_t* out = &level.rgba[(static_cast<std::size_t>(y) * size + x) * 4];
            for (int channel = 0; channel < 3; ++channel)
                out[channel] = static_cast<std::uint8_t>(alpha > 0 ? (weighted[channel] + alpha / 2) / alpha
                                                                   : (plain[channel] + 2) / 4);
            out[3] = static_cast<std::uint8_t>((alpha + 2) / 4);
        }
    }
    return level;
}

Image halved(const Image& source) {
    Image level(std::max(source.width_px / 2, 1), std::max(source.height_px / 2, 1));
    for (int y = 0; y < level.height_px; ++y) {
        for (int x = 0; x < level.width_px; ++x) {
            vec4 plain(0);
            vec3 weighted(0);
            for (int i = 0; i < 4; ++i) {
                const float* texel = source.pixel(std::min(2 * x + i % 2, source.width_px - 1),
                                                  std::min(2 * y + i / 2, source.height_px - 1));
                plain += vec4(texel[0], texel[1], texel[2], texel[3]) / 4.0f;
                weighted += vec3(texel[0], texel[1], texel[2]) * texel[3] / 4.0f;
            }
            const vec3 color = plain.a > 0 ? weighted / plain.a : vec3(plain);
            std::ranges::copy(std::array{color.r, color.g, color.b, plain.a}, level.pixel(x, y));
        }
    }
    return level;
}

}  // namespace

std::vector<TextureLevel> make_texture(const std::string& image, int size_px, int variant) {
    if (image != "leaf" && image != "smoke") throw std::invalid_argument("no procedural texture is called " + image);
    std::vector<TextureLevel> levels = {paint(image, size_px, variant)};
    while (levels.back().size_px > 1) levels.push_back(halved(levels.back()));
    return levels;
}

std::vector<Image> make_mipmaps(Image picture) {
    std::vector<Image> levels;
    levels.push_back(std::move(picture));
    while (levels.back().pixel_count() > 1) levels.push_back(halved(levels.back()));
    return levels;
}

}  // namespace sheer
