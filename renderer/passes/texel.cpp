#include "renderer/passes/texel.h"

#include <array>

#include "renderer/passes/pass.h"

namespace sheer {

glm::vec4 read_texel(const gl::Functions& gl, const gl::Texture& texture, int x, int y) {
    glm::vec4 texel(0);
    gl.MemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    gl.GetTextureSubImage(texture.id(), 0, x, y, 0, 1, 1, 1, GL_RGBA, GL_FLOAT, sizeof texel, &texel[0]);
    return texel;
}

glm::vec4 shade_texel(const gl::Functions& gl, const FullscreenPass& pass, const Target& target, int x, int y,
                      int output) {
    const int width = target.width_px(), height = target.height_px();
    const auto texture = [&] { return gl::make_texture_2d(gl, "one texel", GL_RGBA32F, width, height); };
    const std::array textures = {texture(), texture()};
    const gl::Framebuffer framebuffer =
        gl::make_framebuffer(gl, "one texel", std::array{textures[0].id(), textures[1].id()}, 0);
    {
        Pass drawing(gl, framebuffer, width, height);
        drawing.scissor(x, y, 1, 1);
        pass.draw();
    }
    return read_texel(gl, textures[static_cast<std::size_t>(output)], x, y);
}

}  // namespace sheer
