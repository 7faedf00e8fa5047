#include "renderer/frame/own_depth.h"

#include <array>
#include <span>
#include <stdexcept>

namespace sheer {

namespace {

int depth_bytes_per_pixel(GLenum format) {
    switch (format) {
        case GL_DEPTH_COMPONENT16:
            return 2;
        case GL_DEPTH_COMPONENT24:
        case GL_DEPTH_COMPONENT32F:
        case GL_DEPTH24_STENCIL8:
            return 4;
        case GL_DEPTH32F_STENCIL8:
            return 8;
        default:
            throw std::logic_error("unknown depth format");
    }
}

}  // namespace

OwnDepth::OwnDepth(const gl::Functions& gl, const Target& target, GLuint color, GLenum format)
    : m_gl(gl),
      m_target(target),
      m_format(format),
      m_depth(gl::make_texture_2d(gl, "own depth", format, target.width_px(), target.height_px())),
      m_framebuffer(gl::make_framebuffer(gl, "color with own depth", std::array{color}, m_depth.id())),
      m_depth_only(gl::make_framebuffer(gl, "own depth only", std::span<const GLuint>(), m_depth.id())),
      m_copy(gl, "copy depth", gl::shader_file("common/copy_depth.glsl")) {}

void OwnDepth::clear(float depth) const {
    begin_depth_only();
    const GLint no_stencil = 0;
    m_gl.ClearBufferfv(GL_DEPTH, 0, &depth);
    m_gl.ClearBufferiv(GL_STENCIL, 0, &no_stencil);
}

void OwnDepth::copy_opaque() const {
    clear(1);
    m_gl.Enable(GL_DEPTH_TEST);
    m_gl.DepthFunc(GL_ALWAYS);
    m_gl.BindTextureUnit(first_method_texture_unit, m_target.depth().id());
    m_copy.draw();
}

void OwnDepth::begin_blending() const {
    begin_pass(m_gl, m_framebuffer, m_target.width_px(), m_target.height_px());
    m_gl.Enable(GL_BLEND);
    m_gl.BlendFuncSeparate(GL_DST_ALPHA, GL_ONE, GL_ZERO, GL_SRC_ALPHA);
}

void OwnDepth::begin_depth_only() const {
    begin_pass(m_gl, m_depth_only, m_target.width_px(), m_target.height_px());
}

OwnDepth::Texel OwnDepth::read(int x, int y) const {
    Texel texel;
    m_gl.BindFramebuffer(GL_FRAMEBUFFER, m_depth_only.id());
    m_gl.ReadPixels(x, y, 1, 1, GL_DEPTH_COMPONENT, GL_FLOAT, &texel.depth);
    if (m_format == GL_DEPTH24_STENCIL8 || m_format == GL_DEPTH32F_STENCIL8)
        m_gl.ReadPixels(x, y, 1, 1, GL_STENCIL_INDEX, GL_INT, &texel.stencil);
    return texel;
}

std::int64_t OwnDepth::memory_bytes() const {
    return std::int64_t{m_target.width_px()} * m_target.height_px() * depth_bytes_per_pixel(m_format);
}

}  // namespace sheer
