#include "renderer/frame/float_opaque.h"

#include <array>

namespace sheer {

namespace {

constexpr GLuint unit_of_opaque = first_method_texture_unit, unit_of_accumulation = unit_of_opaque + 1;

}  // namespace

FloatOpaque::FloatOpaque(const gl::Functions& gl, const Scene& scene, const Target& target)
    : m_gl(gl),
      m_target(target),
      m_pass(gl, scene, target),
      m_color(gl::make_texture_2d(gl, "opaque in floats", GL_RGBA32F, target.width_px(), target.height_px())),
      m_framebuffer(gl::make_framebuffer(gl, "opaque in floats", std::array{m_color.id()}, target.depth().id())),
      m_copy(gl, "copy color", gl::shader_file("common/copy_color.glsl")),
      m_composite(gl, "composite once", gl::shader_file("common/composite_once.glsl")) {}

void FloatOpaque::copy_to_target() const {
    begin_pass(m_gl, m_target.framebuffer(), m_target.width_px(), m_target.height_px());
    m_gl.BindTextureUnit(unit_of_opaque, m_color.id());
    m_copy.draw();
}

void FloatOpaque::composite(const gl::Texture& accumulation) const {
    begin_pass(m_gl, m_target.framebuffer(), m_target.width_px(), m_target.height_px());
    m_gl.BindTextureUnit(unit_of_opaque, m_color.id());
    m_gl.BindTextureUnit(unit_of_accumulation, accumulation.id());
    m_composite.draw();
}

std::int64_t FloatOpaque::memory_bytes() const {
    return std::int64_t{m_target.width_px()} * m_target.height_px() * bytes_per_pixel(PixelFormat::rgba32f);
}

Image rounded_to(PixelFormat format, const gl::Functions& gl, const Image& picture) {
    const int width = picture.width_px, height = picture.height_px;
    const gl::Texture source = gl::make_texture_2d(gl, "picture to round", GL_RGBA32F, width, height);
    gl.TextureSubImage2D(source.id(), 0, 0, 0, width, height, GL_RGBA, GL_FLOAT, picture.rgba.data());
    const Target target(gl, {.width_px = width, .height_px = height}, format);
    const FullscreenPass copy(gl, "copy color", gl::shader_file("common/copy_color.glsl"));
    begin_pass(gl, target.framebuffer(), width, height);
    gl.BindTextureUnit(unit_of_opaque, source.id());
    copy.draw();
    return target.read();
}

}  // namespace sheer
