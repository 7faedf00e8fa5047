#include "renderer/methods/shared/blended_sums.h"

#include "renderer/passes/texel.h"

namespace sheer {

GLenum four_channel_sums(const Target& target) {
    return target.format() == PixelFormat::rgba32f ? GL_RGBA32F : GL_RGBA16F;
}

GLenum one_channel_sums(const Target& target) {
    return target.format() == PixelFormat::rgba32f ? GL_R32F : GL_R16F;
}

BlendedSums::BlendedSums(const MethodSetup& setup, const Parts& parts)
    : OpaqueFirst(setup),
      m_textures(parts.textures),
      m_accumulate(
          setup.scene.make_program(parts.label + ": accumulate", gl::shader_file(parts.accumulate), parts.prolog)),
      m_composite(setup.gl, parts.label + ": composite", gl::shader_file(parts.composite), parts.prolog) {
    std::vector<GLuint> colors;
    for (const SumTexture& texture : m_textures) {
        m_sums.push_back(m_target.make_texture(parts.label + ": " + texture.name, texture.format));
        colors.push_back(m_sums.back().id());
    }
    m_framebuffer = gl::make_framebuffer(m_gl, parts.label, colors, m_target.depth().id());
}

void BlendedSums::render(gl::FrameTimer& timer) {
    m_opaque.draw(timer);
    {
        const auto pass = timer.pass("clear", gl::Phase::initialization);
        clear();
    }
    {
        const auto pass = timer.pass("accumulate", gl::Phase::transparent);
        Pass drawing = begin(m_framebuffer);
        drawing.transparent_depth();
        drawing.blend(GL_ONE, GL_ONE);
        for (std::size_t i = 0; i < m_textures.size(); ++i)
            drawing.blend_output(static_cast<GLuint>(i), m_textures[i].source_factor, m_textures[i].target_factor,
                                 m_textures[i].source_factor, m_textures[i].target_factor);
        m_scene.draw_transparent(m_accumulate, Order::submission);
    }
    const auto pass = timer.pass("composite", gl::Phase::finalization);
    const Pass drawing = begin();
    // The composite reads the target that it writes, each pixel once: defined after a barrier (OpenGL 4.5, 9.3.1).
    m_gl.TextureBarrier();
    set_textures();
    m_composite.draw();
}

std::int64_t BlendedSums::memory_bytes() const {
    std::int64_t bytes = 0;
    for (const gl::Texture& texture : m_sums) bytes += texture.memory_bytes();
    return bytes;
}

glm::vec4 BlendedSums::sum_at(const PixelTrace& trace, std::size_t texture) const {
    return read_texel(m_gl, m_sums[texture], trace.x(), trace.y());
}

std::vector<glm::vec4> BlendedSums::read_sum(std::size_t texture) const {
    std::vector<glm::vec4> pixels(static_cast<std::size_t>(m_target.width_px()) * m_target.height_px());
    m_gl.MemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    m_gl.GetTextureImage(m_sums[texture].id(), 0, GL_RGBA, GL_FLOAT,
                         static_cast<GLsizei>(pixels.size() * sizeof(glm::vec4)), pixels.data());
    return pixels;
}

glm::vec4 BlendedSums::composite_at(const PixelTrace& trace, int output) const {
    set_textures();
    return shade_texel(m_gl, m_composite, m_target, trace.x(), trace.y(), output);
}

void BlendedSums::clear() const {
    const Pass clearing = begin(m_framebuffer);
    for (std::size_t i = 0; i < m_textures.size(); ++i)
        clearing.clear_color(glm::vec4(m_textures[i].empty), static_cast<int>(i));
}

void BlendedSums::set_textures() const {
    const gl::Program& program = m_composite.program();
    program.set_texture("u_opaque", m_target.color());
    for (std::size_t i = 0; i < m_textures.size(); ++i)
        program.set_texture(("u_" + m_textures[i].name).c_str(), m_sums[i]);
}

}  // namespace sheer
