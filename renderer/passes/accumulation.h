#pragma once
#include <optional>
#include <string>
#include <vector>

#include "renderer/params/param_table.h"
#include "renderer/passes/pass.h"
#include "renderer/passes/pixel_trace.h"
#include "renderer/passes/target.h"

namespace sheer {

/// How the alpha channel of an accumulation is kept and blended. SCCG 2010, section 2, leaves both open: all choices
/// give the same numbers except for rounding.
struct AlphaForm {
    enum class Factors { zero_src_alpha, dst_alpha_zero };

    /// Whether 1 - opacity, the transmittance, is kept; otherwise the opacity, and a fragment outputs its alpha as it
    /// is with the color factors ONE_MINUS_DST_ALPHA, ONE.
    bool inverted = true;
    /// The product is ZERO, SRC_ALPHA or DST_ALPHA, ZERO; if the opacity is kept, ONE, ONE_MINUS_SRC_ALPHA or
    /// ONE_MINUS_DST_ALPHA, ONE.
    Factors factors = Factors::zero_src_alpha;

    static ParamTable<AlphaForm> table();
    /// `#define SHEER_INVERTED 1` or 0, for shaders that write such an alpha.
    std::string prolog() const;
};

/// The off-screen picture of front-to-back blending (SCCG 2010, section 2): premultiplied color and, in the alpha
/// channel, the remaining transmittance, 1 - opacity, or what `form` says. It shares the depth of the target's
/// opaque pass.
class Accumulation {
  public:
    /// With `separate_alpha` the transmittance is also kept in a texture of one channel, color output 1, for reading.
    Accumulation(const gl::Functions& gl, const Target& target, PixelFormat format, bool separate_alpha = false,
                 AlphaForm form = {});

    /// Clears to no color and the given transmittance, and leaves the framebuffer bound.
    void clear(float transmittance) const;
    /// A pass on it with the depth test of transparent primitives, blending front to back:
    /// color DST_ALPHA, ONE; alpha ZERO, SRC_ALPHA; the separate alpha ZERO, SRC_COLOR; or as the form says.
    [[nodiscard]] Pass blending() const;
    /// Lays it over the target's picture.
    void composite() const;

    const gl::Texture& color() const { return m_color; }
    AlphaForm form() const { return m_form; }
    const gl::Framebuffer& framebuffer() const { return m_framebuffer; }
    /// Where the transmittance can be read: channel a of the shared texture, channel r of the separate one.
    const gl::Texture& readable_alpha() const { return m_separate_alpha ? m_alpha : m_color; }
    std::int64_t memory_bytes() const { return gl::memory_bytes_of(m_color, m_alpha); }

  private:
    const gl::Functions& m_gl;
    const Target& m_target;
    bool m_separate_alpha;
    AlphaForm m_form;
    gl::Texture m_color, m_alpha;
    gl::Framebuffer m_framebuffer;
    FullscreenPass m_composite;
};

/// Adds what an accumulation held in a pixel after the last fragment had been blended; nothing if none was.
void add_accumulated(std::vector<PixelFact>& facts, const std::optional<glm::vec4>& color, AlphaForm form = {});

}  // namespace sheer
