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

struct Factors {
    GLenum source, target;
};

/// T (1 - a) where the transmittance T is kept and 1 - a written, else a + A (1 - a) = A + a (1 - A).
Factors alpha_factors(const AlphaForm& form) {
    if (form.inverted) return form.by_target ? Factors{GL_DST_ALPHA, GL_ZERO} : Factors{GL_ZERO, GL_SRC_ALPHA};
    return form.by_target ? Factors{GL_ONE_MINUS_DST_ALPHA, GL_ONE} : Factors{GL_ONE, GL_ONE_MINUS_SRC_ALPHA};
}

/// The same of a texture that has no alpha channel.
Factors separate_factors(const AlphaForm& form) {
    if (form.inverted) return form.by_target ? Factors{GL_DST_COLOR, GL_ZERO} : Factors{GL_ZERO, GL_SRC_COLOR};
    return form.by_target ? Factors{GL_ONE_MINUS_DST_COLOR, GL_ONE} : Factors{GL_ONE, GL_ONE_MINUS_SRC_COLOR};
}

}  // namespace

std::vector<Param> alpha_form_parameters() {
    return {
        Param::choice("alpha_factors",
                      "blend factors of alpha: ZERO, SRC_ALPHA or DST_ALPHA, ZERO; not inverted, they are "
                      "ONE, ONE_MINUS_SRC_ALPHA and ONE_MINUS_DST_ALPHA, ONE",
                      "zero_src_alpha", {"zero_src_alpha", "dst_alpha_zero"}),
        Param::boolean("inverted",
                       "alpha is kept as 1 - opacity; else as opacity, with the factors ONE_MINUS_DST_ALPHA, ONE for "
                       "colour",
                       true),
    };
}

AlphaForm alpha_form(const nlohmann::json& parameters) {
    return {.inverted = parameters.at("inverted").get<bool>(),
            .by_target = parameters.at("alpha_factors") == "dst_alpha_zero"};
}

std::string alpha_form_prolog(const AlphaForm& form) {
    return form.inverted ? "#define INVERTED 1\n" : "#define INVERTED 0\n";
}

Accumulation::Accumulation(const gl::Functions& gl, const Target& target, PixelFormat format, bool separate_alpha,
                           AlphaForm form)
    : m_gl(gl),
      m_target(target),
      m_format(format),
      m_separate_alpha(separate_alpha),
      m_form(form),
      m_color(gl::make_texture_2d(gl, "accumulation color", gl_format(format), target.width_px(), target.height_px())),
      m_composite(gl, "composite", gl::shader_file("common/composite.glsl")) {
    if (separate_alpha)
        m_alpha = gl::make_texture_2d(gl, "accumulation alpha", single_channel(format), target.width_px(),
                                      target.height_px());
    m_framebuffer = make_framebuffer(gl, m_color, m_alpha, target);
}

void Accumulation::clear(float transmittance) const {
    begin_pass(m_gl, m_framebuffer, m_target.width_px(), m_target.height_px());
    const float kept = m_form.inverted ? transmittance : 1 - transmittance;
    const glm::vec4 color(0, 0, 0, kept), alpha(kept);
    m_gl.ClearBufferfv(GL_COLOR, 0, &color[0]);
    if (m_separate_alpha) m_gl.ClearBufferfv(GL_COLOR, 1, &alpha[0]);
}

void Accumulation::begin_blending() const {
    begin_pass(m_gl, m_framebuffer, m_target.width_px(), m_target.height_px());
    set_transparent_depth_state(m_gl);
    m_gl.Enable(GL_BLEND);
    const Factors alpha = alpha_factors(m_form), separate = separate_factors(m_form);
    m_gl.BlendFuncSeparate(m_form.inverted ? GL_DST_ALPHA : GL_ONE_MINUS_DST_ALPHA, GL_ONE, alpha.source, alpha.target);
    if (m_separate_alpha) m_gl.BlendFuncSeparatei(1, separate.source, separate.target, alpha.source, alpha.target);
}

void Accumulation::composite() const {
    begin_pass(m_gl, m_target.framebuffer(), m_target.width_px(), m_target.height_px());
    m_gl.Enable(GL_BLEND);
    m_gl.BlendFuncSeparate(GL_ONE, m_form.inverted ? GL_SRC_ALPHA : GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
    m_gl.BindTextureUnit(first_method_texture_unit, m_color.id());
    m_composite.draw();
}

void add_accumulated(std::vector<PixelFact>& facts, const std::optional<glm::vec4>& color, AlphaForm form) {
    if (!color) return;
    facts.push_back(color_fact("accumulated", glm::vec3(*color),
                               "What the blended fragments add up to, premultiplied, before anything is behind them."));
    facts.push_back(number_fact("transmittance", form.inverted ? color->a : 1 - color->a,
                                "How much of what is behind the blended fragments is seen."));
}

std::int64_t Accumulation::memory_bytes() const {
    const std::int64_t pixels = std::int64_t{m_target.width_px()} * m_target.height_px();
    const int bytes = bytes_per_pixel(m_format);
    return pixels * (bytes + (m_separate_alpha ? bytes / 4 : 0));
}

}  // namespace sheer
