#pragma once
#include "renderer/passes/pass.h"
#include "renderer/passes/target.h"

namespace sheer {

/// A depth and stencil buffer for methods that need more than the target's depth, with the color of an accumulation.
class OwnDepth {
  public:
    /// `color` is a texture of the target's size; `format` a depth format, with or without stencil.
    OwnDepth(const gl::Functions& gl, const Target& target, GLuint color, GLenum format);

    /// Sets depth to the given value, stencil to 0.
    void clear(float depth) const;
    /// Clears, then copies what the opaque pass left in the target's depth; exact for 32-bit depth.
    void copy_opaque() const;
    /// A pass on the color and this depth, blending front to back: color DST_ALPHA, ONE; alpha ZERO, SRC_ALPHA.
    [[nodiscard]] Pass blending() const;
    /// A pass on this depth alone, so that the color may be read.
    [[nodiscard]] Pass depth_only() const;
    struct Texel {
        float depth = 0;
        GLint stencil = 0;  ///< 0 if there is none
    };
    /// Waits for the device.
    Texel read(int x, int y) const;
    std::int64_t memory_bytes() const { return m_depth.memory_bytes(); }

  private:
    const gl::Functions& m_gl;
    const Target& m_target;
    GLenum m_format;
    gl::Texture m_depth;
    gl::Framebuffer m_framebuffer, m_depth_only;
    FullscreenPass m_copy;
};

}  // namespace sheer
