#pragma once
#include "renderer/passes/target.h"

namespace sheer {

/// Red, green, blue and alpha of the pixel (x, y) of a 2D texture's level 0, not clamped. Waits for the device.
glm::vec4 read_texel(const gl::Functions& gl, const gl::Texture& texture, int x, int y);

/// The output of `pass` at the pixel (x, y) with its current textures and uniforms: color output 0 or 1, in 32-bit
/// floats, without blending. Draws into a texture of its own, of the target's size.
glm::vec4 shade_texel(const gl::Functions& gl, const FullscreenPass& pass, const Target& target, int x, int y,
                      int output = 0);

}  // namespace sheer
