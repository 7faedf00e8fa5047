#include "renderer/passes/accumulation.h"

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

struct BlendFactors {
    GLenum source, target;
};

bool by_target(const AlphaForm& form) {
    return form.factors == AlphaForm::Factors::dst_alpha_zero;
}

/// T (1 - a) if the transmittance T is kept and 1 - a written, otherwise a + A (1 - a) = A + a (1 - A).
BlendFactors alpha_factors(const AlphaForm& form) {
    if (form.inverted)
        return by_target(form) ? BlendFactors{GL_DST_ALPHA, GL_ZERO} : BlendFactors{GL_ZERO, GL_SRC_ALPHA};
    return by_target(form) ? BlendFactors{GL_ONE_MINUS_DST_ALPHA, GL_ONE}
                           : BlendFactors{GL_ONE, GL_ONE_MINUS_SRC_ALPHA};
}

/// The same for a texture without an alpha channel.
BlendFactors separate_factors(const AlphaForm& form) {
    if (form.inverted)
        return by_target(form) ? BlendFactors{GL_DST_COLOR, GL_ZERO} : BlendFactors{GL_ZERO, GL_SRC_COLOR};
    return by_target(form) ? BlendFactors{GL_ONE_MINUS_DST_COLOR, GL_ONE}
                           : BlendFactors{GL_ONE, GL_ONE_MINUS_SRC_COLOR};
}

}  // namespace

ParamTable<AlphaForm> AlphaForm::table() {
    return ParamTable<AlphaForm>()
        .choice(&AlphaForm::factors, "alpha_factors",
                "blend factors of alpha: ZERO, SRC_ALPHA or DST_ALPHA, ZERO; if not inverted, "
                "ONE, ONE_MINUS_SRC_ALPHA or ONE_MINUS_DST_ALPHA, ONE",
                {{"zero_src_alpha", Factors::zero_src_alpha}, {"dst_alpha_zero", Factors::dst_alpha_zero}})
        .boolean(&AlphaForm::inverted, "inverted",
                 "alpha is kept as 1 - opacity; otherwise as opacity, with the factors ONE_MINUS_DST_ALPHA, ONE for "
                 "color");
}

std::string AlphaForm::prolog() const {
    return inverted ? "#define SHEER_INVERTED 1\n" : "#define SHEER_INVERTED 0\n";
}

Accumulation::Accumulation(const gl::Functions& gl, const Target& target, PixelFormat format, bool separate_alpha,
                           AlphaForm form)
    : m_gl(gl),
      m_target(target),
      m_separate_alpha(separate_alpha),
      m_form(form),
      m_color(target.make_texture("accumulation color", gl_format(format))),
      m_composite(gl, "composite", gl::shader_file("common/composite.glsl")) {
    if (separate_alpha) m_alpha = target.make_texture("accumulation alpha", single_channel(format));
    m_framebuffer = make_framebuffer(gl, m_color, m_alpha, target);
}

void Accumulation::clear(float transmittance) const {
    const Pass clearing(m_gl, m_framebuffer, m_target.width_px(), m_target.height_px());
    const float kept = m_form.inverted ? transmittance : 1 - transmittance;
    clearing.clear_color({0, 0, 0, kept});
    if (m_separate_alpha) clearing.clear_color(glm::vec4(kept), 1);
}

Pass Accumulation::blending() const {
    Pass drawing(m_gl, m_framebuffer, m_target.width_px(), m_target.height_px());
    drawing.transparent_depth();
    const BlendFactors alpha = alpha_factors(m_form), separate = separate_factors(m_form);
    drawing.blend(m_form.inverted ? GL_DST_ALPHA : GL_ONE_MINUS_DST_ALPHA, GL_ONE, alpha.source, alpha.target);
    if (m_separate_alpha) drawing.blend_output(1, separate.source, separate.target, alpha.source, alpha.target);
    return drawing;
}

void Accumulation::composite() const {
    Pass drawing(m_gl, m_target);
    drawing.blend(GL_ONE, m_form.inverted ? GL_SRC_ALPHA : GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
    m_composite.program().set_texture("u_accumulation", m_color);
    m_composite.draw();
}

void add_accumulated(std::vector<PixelFact>& facts, const std::optional<glm::vec4>& color, AlphaForm form) {
    if (!color) return;
    facts.push_back(color_fact("accumulated", glm::vec3(*color),
                               "The sum of the blended fragments, premultiplied, without what is behind them."));
    facts.push_back(number_fact("transmittance", form.inverted ? color->a : 1 - color->a,
                                "How much of what is behind the blended fragments is seen."));
}

}  // namespace sheer
