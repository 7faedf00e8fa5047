#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "renderer/frame/pixel_trace.h"
#include "renderer/frame/target.h"
#include "renderer/spec/param.h"

namespace sheer {

/// How the alpha channel of an accumulation is kept and blended. SCCG 2010, section 2, leaves both open: they give the
/// same numbers but for rounding.
struct AlphaForm {
    /// Kept is 1 - opacity, the transmittance; else the opacity, and a fragment gives its alpha as it is:
    /// colour ONE_MINUS_DST_ALPHA, ONE.
    bool inverted = true;
    /// The product is DST_ALPHA, ZERO instead of ZERO, SRC_ALPHA; where the opacity is kept, ONE_MINUS_DST_ALPHA, ONE
    /// instead of ONE, ONE_MINUS_SRC_ALPHA.
    bool by_target = false;
};

/// `alpha_factors` and `inverted`, and what they say.
std::vector<Param> alpha_form_parameters();
AlphaForm alpha_form(const nlohmann::json& parameters);
/// `#define INVERTED 1` or 0, for shaders that write such an alpha.
std::string alpha_form_prolog(const AlphaForm& form);

/// The off-screen picture of front-to-back blending (SCCG 2010, section 2): premultiplied colour and, in the alpha
/// channel, the transmittance that is left, 1 - opacity, or what `form` says. It shares the depth of the target's
/// opaque pass.
class Accumulation {
  public:
    /// With `separate_alpha` the transmittance is also kept in a texture of one channel, colour output 1, for reading.
    Accumulation(const gl::Functions& gl, const Target& target, PixelFormat format, bool separate_alpha = false,
                 AlphaForm form = {});

    /// Clears to no colour and the given transmittance, and leaves the framebuffer bound.
    void clear(float transmittance) const;
    /// begin_pass on it, the transparent depth state, and blending front to back:
    /// colour DST_ALPHA, ONE; alpha ZERO, SRC_ALPHA; the separate alpha ZERO, SRC_COLOR; or as the form says.
    void begin_blending() const;
    /// Lays it over the target's picture.
    void composite() const;

    const gl::Texture& color() const { return m_color; }
    AlphaForm form() const { return m_form; }
    const gl::Framebuffer& framebuffer() const { return m_framebuffer; }
    /// Where the transmittance can be read: channel a of the shared texture, channel r of the separate one.
    const gl::Texture& readable_alpha() const { return m_separate_alpha ? m_alpha : m_color; }
    std::int64_t memory_bytes() const;

  private:
    const gl::Functions& m_gl;
    const Target& m_target;
    PixelFormat m_format;
    bool m_separate_alpha;
    AlphaForm m_form;
    gl::Texture m_color, m_alpha;
    gl::Framebuffer m_framebuffer;
    FullscreenPass m_composite;
};

/// Tells of a pixel what an accumulation held when the last fragment had been blended; nothing if none was.
void add_accumulated(std::vector<PixelFact>& facts, const std::optional<glm::vec4>& color, AlphaForm form = {});

}  // namespace sheer
