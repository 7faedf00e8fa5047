#include "renderer/passes/frame_mean.h"

#include <array>

namespace sheer {

FrameMean::FrameMean(const gl::Functions& gl, const Target& target)
    : m_gl(gl),
      m_target(target),
      m_sum(target.make_texture("frame mean", GL_RGBA32F)),
      m_framebuffer(gl::make_framebuffer(gl, "frame mean", std::array{m_sum.id()}, 0)),
      m_copy(gl, "frame mean", gl::shader_file("common/scaled_color.glsl")) {}

void FrameMean::clear() const {
    const Pass clearing(m_gl, m_framebuffer, m_target.width_px(), m_target.height_px());
    clearing.clear_color(glm::vec4(0));
}

void FrameMean::add() const {
    Pass drawing(m_gl, m_framebuffer, m_target.width_px(), m_target.height_px());
    drawing.blend(GL_ONE, GL_ONE);
    m_copy.program().set_texture("u_color", m_target.color());
    m_copy.program().set("u_factor", 1.0f);
    m_copy.draw();
}

void FrameMean::write(int count) const {
    const Pass drawing(m_gl, m_target);
    m_copy.program().set_texture("u_color", m_sum);
    m_copy.program().set("u_factor", 1.0f / static_cast<float>(count));
    m_copy.draw();
}

}  // namespace sheer
