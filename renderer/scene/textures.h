#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "renderer/image/image.h"

namespace sheer {

/// How many textures a scene has.
inline constexpr int texture_count = 4;

/// One level of a texture: rows from the top down, 4 interleaved channels of 8 bits, straight alpha.
struct TextureLevel {
    int size_px = 0;
    std::vector<std::uint8_t> rgba;
};

/// A procedural square texture with all its mipmaps, down to 1x1.
///
/// `image` is "leaf" (leaves with soft edges, veins and holes between them) or "smoke" (a soft cloud); `variant` 0..3
/// gives the four different textures of a scene. Only additions, multiplications, divisions and square roots are used,
/// so that the bytes are the same on every platform. Mipmaps are box-filtered with the color weighted by alpha.
/// Throws std::invalid_argument for another `image`.
std::vector<TextureLevel> make_texture(const std::string& image, int size_px, int variant);

/// The picture and its mipmaps, down to 1x1, filtered in the same way. Each level is half the one before, rounded down;
/// if a side is odd, its last row or column is left out, as in the non-power-of-two box filter.
std::vector<Image> make_mipmaps(Image picture);

}  // namespace sheer
