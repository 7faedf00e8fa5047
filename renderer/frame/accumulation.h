#pragma once
#include <optional>
#include <vector>

#include "renderer/frame/pixel_trace.h"
#include "renderer/frame/target.h"

namespace sheer {

/// The off-screen picture of front-to-back blending (SCCG 2010, section 2): premultiplied colour and, in the alpha
/// channel, the transmittance that is left, 1 - opacity. It shares the depth of the target's opaque pass.
class Accumulation {
  public:
    /// With `separate_alpha` the transmittance is also kept in a texture of one channel, colour output 1, for reading.
    Accumulation(const gl::Functions& gl, const Target& target, PixelFormat format, bool separate_alpha = false);

    /// Clears to no colour and the given transmittance, and leaves the framebuffer bound.
    void clear(float transmittance) const;
    /// begin_pass on it, the transparent depth state, and blending front to back:
    /// colour DST_ALPHA, ONE; alpha ZERO, SRC_ALPHA; the separate alpha ZERO, SRC_COLOR.
    void begin_blending() const;
    /// Lays it over the target's picture.
    void composite() const;

    const gl::Framebuffer& framebuffer() const { return m_framebuffer; }
    /// Where the transmittance can be read: channel a of the shared texture, channel r of the separate one.
    const gl::Texture& readable_alpha() const { return m_separate_alpha ? m_alpha : m_color; }
    std::int64_t memory_bytes() const;

  private:
    const gl::Functions& m_gl;
    const Target& m_target;
    PixelFormat m_format;
    bool m_separate_alpha;
    gl::Texture m_color, m_alpha;
    gl::Framebuffer m_framebuffer;
    FullscreenPass m_composite;
};

/// Tells of a pixel what an accumulation held when the last fragment had been blended; nothing if none was.
void add_accumulated(std::vector<PixelFact>& facts, const std::optional<glm::vec4>& color);

}  // namespace sheer
