#include "renderer/methods/shared/two_pass_blending.h"

#include <array>

#include "renderer/passes/texel.h"

namespace sheer {

TwoPassBlending::TwoPassBlending(const MethodSetup& setup, const Parts& parts)
    : OpaqueFirst(setup),
      m_textures(parts.textures),
      m_sum(setup.target.make_texture(parts.label + ": sum", GL_RGBA32F)),
      m_transmittance(setup.target.make_texture(parts.label + ": transmittance", GL_R32F)),
      m_generate(setup.scene.make_program(parts.label + ": generate", parts.generate, parts.prolog)),
      m_blend(setup.scene.make_program(parts.label + ": blend", parts.blend, parts.prolog)),
      m_composite(setup.gl, parts.label + ": composite", gl::shader_file("common/normalised_blend.glsl")) {
    const GLuint depth = m_target.depth().id();
    std::vector<GLuint> colors;
    for (const SumTexture& texture : m_textures) {
        m_first.push_back(m_target.make_texture(parts.label + ": " + texture.name, texture.format));
        colors.push_back(m_first.back().id());
    }
    m_first_framebuffer = gl::make_framebuffer(m_gl, parts.label + ": first", colors, depth);
    m_second_framebuffer =
        gl::make_framebuffer(m_gl, parts.label + ": second", std::array{m_sum.id(), m_transmittance.id()}, depth);
}

void TwoPassBlending::render(gl::FrameTimer& timer) {
    m_opaque.draw(timer);
    {
        const auto pass = timer.pass("generate", gl::Phase::transparent);
        draw_first();
    }
    {
        const auto pass = timer.pass("blend", gl::Phase::transparent);
        draw_second();
    }
    const auto pass = timer.pass("composite", gl::Phase::finalization);
    composite();
}

void TwoPassBlending::draw_first() const {
    Pass drawing = begin(m_first_framebuffer);
    drawing.transparent_depth();
    drawing.blend(GL_ONE, GL_ONE);
    for (std::size_t i = 0; i < m_textures.size(); ++i) {
        const SumTexture& texture = m_textures[i];
        drawing.clear_color(glm::vec4(texture.empty), static_cast<int>(i));
        drawing.blend_output(static_cast<GLuint>(i), texture.source_factor, texture.target_factor,
                             texture.source_factor, texture.target_factor);
    }
    m_scene.draw_transparent(m_generate, Order::submission);
}

void TwoPassBlending::draw_second() const {
    Pass drawing = begin(m_second_framebuffer);
    drawing.clear_color(glm::vec4(0));
    drawing.clear_color(glm::vec4(1), 1);
    drawing.transparent_depth();
    drawing.blend(GL_ONE, GL_ONE);
    drawing.blend_output(1, GL_ZERO, GL_ONE_MINUS_SRC_COLOR, GL_ZERO, GL_ONE_MINUS_SRC_ALPHA);
    for (std::size_t i = 0; i < m_textures.size(); ++i)
        m_blend.set_texture(("u_" + m_textures[i].name).c_str(), m_first[i]);
    m_scene.draw_transparent(m_blend, Order::submission);
}

/// Reads the target that it writes, each pixel once: defined after a texture barrier (OpenGL 4.5, 9.3.1).
void TwoPassBlending::composite() const {
    const Pass drawing = begin();
    m_gl.TextureBarrier();
    const gl::Program& program = m_composite.program();
    program.set_texture("u_opaque", m_target.color());
    program.set_texture("u_sum", m_sum);
    program.set_texture("u_transmittance", m_transmittance);
    m_composite.draw();
}

std::vector<PixelFact> TwoPassBlending::explain(const PixelTrace& trace) const {
    const glm::vec4 sum = read_texel(m_gl, m_sum, trace.x(), trace.y());
    return {color_fact("color_sum", glm::vec3(sum),
                       "The sum over all fragments of alpha times color times what those in front are taken to let "
                       "through."),
            number_fact("weight_sum", sum.a, "The same sum without the colors, by which color_sum is divided."),
            number_fact("opaque_weight", read_texel(m_gl, m_transmittance, trace.x(), trace.y()).r,
                        "The weight of the opaque color, the product of one minus each alpha.")};
}

std::int64_t TwoPassBlending::memory_bytes() const {
    std::int64_t bytes = gl::memory_bytes_of(m_sum, m_transmittance);
    for (const gl::Texture& texture : m_first) bytes += texture.memory_bytes();
    return bytes;
}

}  // namespace sheer
