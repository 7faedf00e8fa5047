#pragma once
#include <compare>
#include <map>

#include "renderer/gl/context.h"
#include "renderer/gl/objects.h"

namespace sheer {

/// The properties of the shader and of the state that may decide whether a device tests a fragment before shading it.
struct DrawKind {
    bool discards = false;
    bool writes_sample_mask = false;
    bool fetches_framebuffer = false;  ///< with GL_EXT_shader_framebuffer_fetch
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
/// OpenGL puts the tests after the shader, but lets a driver test earlier if that has no visible effect. Which drivers
/// do so for which shaders is not documented, and counting in the shader itself is a visible effect, so it would change
/// the answer. So it is found by timing: a stand-in of the same kind with a long loop is drawn over a small picture,
/// with a test that all fragments pass and with one that all fail. Both take the same time, or the failing one hardly
/// any.
class EarlyTests {
  public:
    /// `context` outlives it.
    explicit EarlyTests(const gl::Context& context) : m_context(context) {}

    /// For a kind that tests something. Draws some dozens of small frames, once for each kind: milliseconds each.
    /// `unclear` if the times are neither similar nor far apart, or if depth and stencil are tested differently.
    TestTime ask(const DrawKind& kind);

  private:
    const gl::Context& m_context;
    std::map<DrawKind, TestTime> m_known;
};

}  // namespace sheer
