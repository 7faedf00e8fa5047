#include "renderer/passes/target.h"

#include <array>
#include <stdexcept>

#include "renderer/passes/pass.h"

namespace sheer {

GLenum gl_format(PixelFormat format) {
    switch (format) {
        case PixelFormat::rgba8:
            return GL_RGBA8;
        case PixelFormat::rgba16f:
            return GL_RGBA16F;
        case PixelFormat::rgba32f:
            return GL_RGBA32F;
    }
    throw std::logic_error("unknown pixel format");
}

Target::Target(const gl::Functions& gl, const ImageSpec& image, PixelFormat format)
    : m_gl(gl),
      m_image(image),
      m_format(format),
      m_color(gl::make_texture_2d(gl, "target color", gl_format(format), image.width_px, image.height_px)),
      m_depth(gl::make_texture_2d(gl, "target depth", GL_DEPTH_COMPONENT32F, image.width_px, image.height_px)),
      m_framebuffer(gl::make_framebuffer(gl, "target", std::array{m_color.id()}, m_depth.id())) {}

Image Target::read() const {
    Image image(width_px(), height_px());
    m_gl.MemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    m_gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
    m_gl.GetTextureImage(m_color.id(), 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(image.rgba.size() * sizeof(float)),
                         image.rgba.data());
    return image;
}

OpaquePass::OpaquePass(const gl::Functions& gl, const Scene& scene, const Target& target)
    : m_gl(gl),
      m_scene(scene),
      m_target(target),
      m_program(scene.make_program("opaque", gl::shader_file("common/opaque.glsl"))) {}

void OpaquePass::draw_into(const gl::Framebuffer& framebuffer, gl::FrameTimer& timer) const {
    const auto pass = timer.pass("opaque", gl::Phase::opaque);
    Pass drawing(m_gl, framebuffer, m_target.width_px(), m_target.height_px());
    drawing.clear_color(glm::vec4(m_target.background(), 1));
    drawing.clear_depth(1);
    drawing.depth_test(GL_LEQUAL);
    m_scene.draw_opaque(m_program);
}

FullscreenPass::FullscreenPass(const gl::Functions& gl, std::string_view label, std::string_view source,
                               const std::string& prolog)
    : m_gl(gl),
      m_program(gl, label, gl::shader_file("common/fullscreen.vert.glsl"), glsl_version + prolog + std::string(source)),
      m_vertex_array(gl::make_vertex_array(gl, "fullscreen")) {}

void FullscreenPass::draw() const {
    m_program.use();
    m_gl.BindVertexArray(m_vertex_array.id());
    m_gl.DrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace sheer
