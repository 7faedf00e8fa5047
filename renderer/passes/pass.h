#pragma once
#include <cstdint>
#include <glm/glm.hpp>

#include "renderer/gl/objects.h"
#include "renderer/passes/target.h"

namespace sheer {

/// A pass of a frame: begins with the framebuffer bound and all state as passes expect it, and at its end restores what
/// was set in between. Passes do not nest.
///
/// State at the beginning: drawing over the whole framebuffer, origin top left, depth 0..1; no blending, no depth or
/// stencil test; color, depth and stencil are written; no culling, scissor, polygon offset or alpha to coverage.
class Pass {
  public:
    Pass(const gl::Functions& gl, const gl::Framebuffer& framebuffer, int width_px, int height_px);
    Pass(const gl::Functions& gl, const Target& target)
        : Pass(gl, target.framebuffer(), target.width_px(), target.height_px()) {}
    Pass(Pass&& other) noexcept;
    Pass& operator=(Pass&&) = delete;
    ~Pass();

    void clear_color(const glm::vec4& color, int output = 0) const;
    void clear_color(const glm::uvec4& color, int output) const;
    void clear_depth(float depth) const;
    void clear_stencil(int value) const;

    /// Without a depth test no depth is written either.
    void depth_test(GLenum function);
    void no_depth_test();
    void depth_write(bool on);
    /// For transparent primitives: opaque ones hide them, but they do not hide each other. (LEQUAL, no depth writes.)
    void transparent_depth();
    void depth_range(double near, double far);
    void polygon_offset(float factor, float units);

    void color_mask(bool red, bool green, bool blue, bool alpha);
    void no_color();
    void blend(GLenum source, GLenum target);
    void blend(GLenum color_source, GLenum color_target, GLenum alpha_source, GLenum alpha_target);
    /// For one color output; call it after blend(), which is for all.
    void blend_output(GLuint output, GLenum color_source, GLenum color_target, GLenum alpha_source,
                      GLenum alpha_target);
    void blend_equation(GLenum color, GLenum alpha);
    /// For one color output; call it after blend_equation() if there is one.
    void blend_equation_output(GLuint output, GLenum equation);
    void alpha_to_coverage();

    /// Passes where `function` holds between `reference` and the stored value, as glStencilFunc.
    void stencil(GLenum function, int reference, GLenum stencil_fails, GLenum depth_fails, GLenum passes);
    void stencil_mask(unsigned bits);

    void scissor(int x, int y, int width_px, int height_px);
    void cull(GLenum face);

  private:
    /// What was set and must be restored.
    enum State : unsigned {
        depth_testing = 1u << 0,
        depth_writing = 1u << 1,
        depth_ranging = 1u << 2,
        offsetting = 1u << 3,
        color_masking = 1u << 4,
        blending = 1u << 5,
        blend_equations = 1u << 6,
        covering = 1u << 7,
        stencil_testing = 1u << 8,
        stencil_masking = 1u << 9,
        scissoring = 1u << 10,
        culling = 1u << 11,
    };
    void reset(unsigned states) const;

    const gl::Functions* m_gl;
    unsigned m_set = 0;
};

}  // namespace sheer
