#include "renderer/passes/pass.h"

#include <utility>

namespace sheer {

Pass::Pass(const gl::Functions& gl, const gl::Framebuffer& framebuffer, int width_px, int height_px) : m_gl(&gl) {
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
    gl.ClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
    gl.Viewport(0, 0, width_px, height_px);
    gl.Disable(GL_DITHER);
    // Nothing is assumed about state that code other than passes left, such as a window toolkit.
    reset(~0u);
}

Pass::Pass(Pass&& other) noexcept : m_gl(other.m_gl), m_set(std::exchange(other.m_set, 0)) {}

Pass::~Pass() {
    reset(m_set);
}

void Pass::reset(unsigned states) const {
    const gl::Functions& gl = *m_gl;
    if (states & depth_testing) {
        gl.Disable(GL_DEPTH_TEST);
        gl.DepthFunc(GL_LESS);
    }
    if (states & depth_writing) gl.DepthMask(GL_TRUE);
    if (states & depth_ranging) gl.DepthRange(0, 1);
    if (states & offsetting) {
        gl.Disable(GL_POLYGON_OFFSET_FILL);
        gl.PolygonOffset(0, 0);
    }
    if (states & color_masking) gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    if (states & blending) {
        gl.Disable(GL_BLEND);
        gl.BlendFunc(GL_ONE, GL_ZERO);
    }
    if (states & blend_equations) gl.BlendEquation(GL_FUNC_ADD);
    if (states & covering) gl.Disable(GL_SAMPLE_ALPHA_TO_COVERAGE);
    if (states & stencil_testing) {
        gl.Disable(GL_STENCIL_TEST);
        gl.StencilFunc(GL_ALWAYS, 0, 0xff);
        gl.StencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
    }
    if (states & stencil_masking) gl.StencilMask(0xff);
    if (states & scissoring) gl.Disable(GL_SCISSOR_TEST);
    if (states & culling) {
        gl.Disable(GL_CULL_FACE);
        gl.CullFace(GL_BACK);
    }
}

void Pass::clear_color(const glm::vec4& color, int output) const {
    m_gl->ClearBufferfv(GL_COLOR, output, &color[0]);
}

void Pass::clear_color(const glm::uvec4& color, int output) const {
    m_gl->ClearBufferuiv(GL_COLOR, output, &color[0]);
}

void Pass::clear_depth(float depth) const {
    m_gl->ClearBufferfv(GL_DEPTH, 0, &depth);
}

void Pass::clear_stencil(int value) const {
    const GLint stencil = value;
    m_gl->ClearBufferiv(GL_STENCIL, 0, &stencil);
}

void Pass::depth_test(GLenum function) {
    m_set |= depth_testing;
    m_gl->Enable(GL_DEPTH_TEST);
    m_gl->DepthFunc(function);
}

void Pass::no_depth_test() {
    m_gl->Disable(GL_DEPTH_TEST);
}

void Pass::depth_write(bool on) {
    m_set |= depth_writing;
    m_gl->DepthMask(on ? GL_TRUE : GL_FALSE);
}

void Pass::transparent_depth() {
    depth_test(GL_LEQUAL);
    depth_write(false);
}

void Pass::depth_range(double near, double far) {
    m_set |= depth_ranging;
    m_gl->DepthRange(near, far);
}

void Pass::polygon_offset(float factor, float units) {
    m_set |= offsetting;
    m_gl->Enable(GL_POLYGON_OFFSET_FILL);
    m_gl->PolygonOffset(factor, units);
}

void Pass::color_mask(bool red, bool green, bool blue, bool alpha) {
    m_set |= color_masking;
    m_gl->ColorMask(red ? GL_TRUE : GL_FALSE, green ? GL_TRUE : GL_FALSE, blue ? GL_TRUE : GL_FALSE,
                    alpha ? GL_TRUE : GL_FALSE);
}

void Pass::no_color() {
    color_mask(false, false, false, false);
}

void Pass::blend(GLenum source, GLenum target) {
    blend(source, target, source, target);
}

void Pass::blend(GLenum color_source, GLenum color_target, GLenum alpha_source, GLenum alpha_target) {
    m_set |= blending;
    m_gl->Enable(GL_BLEND);
    m_gl->BlendFuncSeparate(color_source, color_target, alpha_source, alpha_target);
}

void Pass::blend_output(GLuint output, GLenum color_source, GLenum color_target, GLenum alpha_source,
                        GLenum alpha_target) {
    m_set |= blending;
    m_gl->BlendFuncSeparatei(output, color_source, color_target, alpha_source, alpha_target);
}

void Pass::blend_equation(GLenum color, GLenum alpha) {
    m_set |= blend_equations;
    m_gl->BlendEquationSeparate(color, alpha);
}

void Pass::blend_equation_output(GLuint output, GLenum equation) {
    m_set |= blend_equations;
    m_gl->BlendEquationi(output, equation);
}

void Pass::alpha_to_coverage() {
    m_set |= covering;
    m_gl->Enable(GL_SAMPLE_ALPHA_TO_COVERAGE);
}

void Pass::stencil(GLenum function, int reference, GLenum stencil_fails, GLenum depth_fails, GLenum passes) {
    m_set |= stencil_testing;
    m_gl->Enable(GL_STENCIL_TEST);
    m_gl->StencilFunc(function, reference, 0xff);
    m_gl->StencilOp(stencil_fails, depth_fails, passes);
}

void Pass::stencil_mask(unsigned bits) {
    m_set |= stencil_masking;
    m_gl->StencilMask(bits);
}

void Pass::scissor(int x, int y, int width_px, int height_px) {
    m_set |= scissoring;
    m_gl->Enable(GL_SCISSOR_TEST);
    m_gl->Scissor(x, y, width_px, height_px);
}

void Pass::cull(GLenum face) {
    m_set |= culling;
    m_gl->Enable(GL_CULL_FACE);
    m_gl->CullFace(face);
}

}  // namespace sheer
