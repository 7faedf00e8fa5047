#pragma once
#include <compare>
#include <map>

#include "renderer/gl/context.h"
#include "renderer/gl/objects.h"

namespace sheer {

/// What may decide whether a device tests a fragment before it shades it: of the shader, and of the state.
struct DrawKind {
    bool discards = false;
    bool writes_sample_mask = false;
    bool fetches_framebuffer = false;  ///< by GL_EXT_shader_framebuffer_fetch
    bool tests_depth = false;
    bool writes_depth = false;
    bool tests_stencil = false;
    bool has_stencil_mask = false;  ///< whether any bit of the stencil may be written
    GLint stencil_fails = GL_KEEP, depth_fails = GL_KEEP, depth_passes = GL_KEEP;  ///< as glStencilOp
    bool covers_by_alpha = false;
    int samples = 1;  ///< per pixel

    bool tests() const { return tests_depth || tests_stencil; }
    bool writes_stencil() const;
    auto operator<=>(const DrawKind&) const = default;
};

enum class TestTime { early, late, unclear };

/// Finds out when this device tests a fragment's depth and stencil: before the shader runs or after it.
///
/// OpenGL puts the tests after the shader, but lets a driver test before where that cannot be seen; which drivers do
/// it for which shaders is written nowhere, and counting in the shader itself would be seen, so that it changes the
/// answer. It is told by time: a stand-in of the same kind with a long loop is drawn over a small picture, with a test
/// that all fragments pass and with one that all fail. Both take the same time, or the failing one hardly any.
class EarlyTests {
  public:
    /// `context` outlives it.
    explicit EarlyTests(const gl::Context& context) : m_context(context) {}

    /// Of a kind that tests something. Draws some dozens of small frames, once for each kind: milliseconds each.
    /// `unclear` where the times are neither alike nor far apart, or where depth and stencil are tested differently.
    TestTime ask(const DrawKind& kind);

  private:
    const gl::Context& m_context;
    std::map<DrawKind, TestTime> m_known;
};

}  // namespace sheer
