#include "renderer/frame/accumulation.h"

#include <stdexcept>
#include <vector>

namespace sheer {

namespace {

GLenum single_channel(PixelFormat format) {
    switch (format) {
        case PixelFormat::rgba8:
            return GL_R8;
        case PixelFormat::rgba16f:
            return GL_R16F;
        case PixelFormat::rgba32f:
            return GL_R32F;
    }
    throw std::logic_error("unknown pixel format");
}

gl::Framebuffer make_framebuffer(const gl::Functions& gl, const gl::Texture& color, const gl::Texture& alpha,
                                 const Target& target) {
    std::vector<GLuint> colors = {color.id()};
    if (alpha) colors.push_back(alpha.id());
    return gl::make_framebuffer(gl, "accumulation", colors, target.depth().id());
}

}  // namespace

Accumulation::Accumulation(const gl::Functions& gl, const Target& target, PixelFormat format, bool separate_alpha)
    : m_gl(gl),
      m_target(target),
      m_format(format),
      m_separate_alpha(separate_alpha),
      m_color(gl::make_texture_2d(gl, "accumulation color", gl_format(format), target.width_px(), target.height_px())),
      m_composite(gl, "composite", gl::shader_file("common/composite.glsl")) {
    if (separate_alpha)
        m_alpha = gl::make_texture_2d(gl, "accumulation alpha", single_channel(format), target.width_px(),
                                      target.height_px());
    m_framebuffer = make_framebuffer(gl, m_color, m_alpha, target);
}

void Accumulation::clear(float transmittance) const {
    begin_pass(m_gl, m_framebuffer, m_target.width_px(), m_target.height_px());
    const glm::vec4 color(0, 0, 0, transmittance), alpha(transmittance);
    m_gl.ClearBufferfv(GL_COLOR, 0, &color[0]);
    if (m_separate_alpha) m_gl.ClearBufferfv(GL_COLOR, 1, &alpha[0]);
}

void Accumulation::begin_blending() const {
    begin_pass(m_gl, m_framebuffer, m_target.width_px(), m_target.height_px());
    set_transparent_depth_state(m_gl);
    m_gl.Enable(GL_BLEND);
    m_gl.BlendFuncSeparate(GL_DST_ALPHA, GL_ONE, GL_ZERO, GL_SRC_ALPHA);
    if (m_separate_alpha) m_gl.BlendFuncSeparatei(1, GL_ZERO, GL_SRC_COLOR, GL_ZERO, GL_SRC_ALPHA);
}

void Accumulation::composite() const {
    begin_pass(m_gl, m_target.framebuffer(), m_target.width_px(), m_target.height_px());
    m_gl.Enable(GL_BLEND);
    m_gl.BlendFuncSeparate(GL_ONE, GL_SRC_ALPHA, GL_ZERO, GL_ONE);
    m_gl.BindTextureUnit(first_method_texture_unit, m_color.id());
    m_composite.draw();
}

void add_accumulated(std::vector<PixelFact>& facts, const std::optional<glm::vec4>& color) {
    if (!color) return;
    facts.push_back(color_fact("accumulated", glm::vec3(*color),
                               "What the blended fragments add up to, premultiplied, before anything is behind them."));
    facts.push_back(
        number_fact("transmittance", color->a, "How much of what is behind the blended fragments is seen."));
}

std::int64_t Accumulation::memory_bytes() const {
    const std::int64_t pixels = std::int64_t{m_target.width_px()} * m_target.height_px();
    const int bytes = bytes_per_pixel(m_format);
    return pixels * (bytes + (m_separate_alpha ? bytes / 4 : 0));
}

}  // namespace sheer
