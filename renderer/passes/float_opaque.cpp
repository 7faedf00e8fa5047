#include "renderer/passes/float_opaque.h"

#include <array>

#include "renderer/passes/pass.h"

namespace sheer {

FloatOpaque::FloatOpaque(const gl::Functions& gl, const Scene& scene, const Target& target)
    : m_gl(gl),
      m_target(target),
      m_pass(gl, scene, target),
      m_color(target.make_texture("opaque in floats", GL_RGBA32F)),
      m_framebuffer(gl::make_framebuffer(gl, "opaque in floats", std::array{m_color.id()}, target.depth().id())),
      m_copy(gl, "copy color", gl::shader_file("common/copy_color.glsl")),
      m_composite(gl, "composite once", gl::shader_file("common/composite_once.glsl")) {}

void FloatOpaque::copy_to_target() const {
    const Pass drawing(m_gl, m_target);
    m_copy.program().set_texture("u_color", m_color);
    m_copy.draw();
}

void FloatOpaque::composite(const gl::Texture& accumulation) const {
    const Pass drawing(m_gl, m_target);
    m_composite.program().set_texture("u_opaque", m_color);
    m_composite.program().set_texture("u_accumulation", accumulation);
    m_composite.draw();
}

Image rounded_to(PixelFormat format, const gl::Functions& gl, const Image& picture) {
    const int width = picture.width_px, height = picture.height_px;
    const gl::Texture source = gl::make_texture_2d(gl, "picture to round", GL_RGBA32F, width, height);
    gl.TextureSubImage2D(source.id(), 0, 0, 0, width, height, GL_RGBA, GL_FLOAT, picture.rgba.data());
    const Target target(gl, {.width_px = width, .height_px = height}, format);
    const FullscreenPass copy(gl, "copy color", gl::shader_file("common/copy_color.glsl"));
    const Pass drawing(gl, target);
    copy.program().set_texture("u_color", source);
    copy.draw();
    return target.read();
}

}  // namespace sheer
