#pragma once
#include "renderer/passes/target.h"

namespace sheer {

/// The opaque picture in 32-bit floats, for methods whose picture is rounded once: they composite in a shader that
/// reads it and writes the target without blending.
class FloatOpaque {
  public:
    FloatOpaque(const gl::Functions& gl, const Scene& scene, const Target& target);

    /// Draws the opaque pass: the color is kept here, the depth is the target's.
    void draw(gl::FrameTimer& timer) const { m_pass.draw_into(m_framebuffer, timer); }
    /// Writes it to the target, rounded to its format.
    void copy_to_target() const;
    /// Lays a front-to-back accumulation (premultiplied color, transmittance) over it, and writes that to the target.
    void composite(const gl::Texture& accumulation) const;

    const gl::Texture& color() const { return m_color; }
    std::int64_t memory_bytes() const { return m_color.memory_bytes(); }

  private:
    const gl::Functions& m_gl;
    const Target& m_target;
    OpaquePass m_pass;
    gl::Texture m_color;
    gl::Framebuffer m_framebuffer;
    FullscreenPass m_copy, m_composite;
};

/// `picture` as a target of this format would hold it: written by a shader, so that the device rounds it as it rounds
/// what methods write. Waits for the device.
Image rounded_to(PixelFormat format, const gl::Functions& gl, const Image& picture);

}  // namespace sheer
