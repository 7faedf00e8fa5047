#include "renderer/passes/own_depth.h"

#include <array>
#include <span>

namespace sheer {

OwnDepth::OwnDepth(const gl::Functions& gl, const Target& target, GLuint color, GLenum format)
    : m_gl(gl),
      m_target(target),
      m_format(format),
      m_depth(target.make_texture("own depth", format)),
      m_framebuffer(gl::make_framebuffer(gl, "color with own depth", std::array{color}, m_depth.id())),
      m_depth_only(gl::make_framebuffer(gl, "own depth only", std::span<const GLuint>(), m_depth.id())),
      m_copy(gl, "copy depth", gl::shader_file("common/copy_depth.glsl")) {}

void OwnDepth::clear(float depth) const {
    const Pass clearing = depth_only();
    clearing.clear_depth(depth);
    clearing.clear_stencil(0);
}

void OwnDepth::copy_opaque() const {
    clear(1);
    Pass drawing = depth_only();
    drawing.depth_test(GL_ALWAYS);
    m_copy.program().set_texture("u_depth", m_target.depth());
    m_copy.draw();
}

Pass OwnDepth::blending() const {
    Pass drawing(m_gl, m_framebuffer, m_target.width_px(), m_target.height_px());
    drawing.blend(GL_DST_ALPHA, GL_ONE, GL_ZERO, GL_SRC_ALPHA);
    return drawing;
}

Pass OwnDepth::depth_only() const {
    return {m_gl, m_depth_only, m_target.width_px(), m_target.height_px()};
}

OwnDepth::Texel OwnDepth::read(int x, int y) const {
    Texel texel;
    m_gl.BindFramebuffer(GL_FRAMEBUFFER, m_depth_only.id());
    m_gl.ReadPixels(x, y, 1, 1, GL_DEPTH_COMPONENT, GL_FLOAT, &texel.depth);
    if (m_format == GL_DEPTH24_STENCIL8 || m_format == GL_DEPTH32F_STENCIL8)
        m_gl.ReadPixels(x, y, 1, 1, GL_STENCIL_INDEX, GL_INT, &texel.stencil);
    return texel;
}

}  // namespace sheer
