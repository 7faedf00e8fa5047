#pragma once
#include <string>
#include <vector>

#include "renderer/methods/shared/blended_sums.h"

namespace sheer {

/// A method that draws the transparent fragments twice, in any order. The first pass sums what the transmittance in
/// front of a depth is reconstructed from. The second adds colors and alphas weighted by that, and multiplies the exact
/// transmittance of the whole pixel; the mean color is then laid over the opaque picture with the exact opacity.
///
/// The shader of the second pass gets the textures of the first by their names. Its outputs are a sum of (color times
/// weight, weight) and an alpha.
class TwoPassBlending : public OpaqueFirst {
  public:
    struct Parts {
        std::string label;
        std::vector<SumTexture> textures;  ///< of the first pass, with their blending
        std::string generate, blend;       ///< the shaders of the two passes
        std::string prolog = {};           ///< of both
    };

    void render(gl::FrameTimer& timer) override;
    std::vector<PixelFact> explain(const PixelTrace& trace) const override;
    std::int64_t memory_bytes() const override;

  protected:
    TwoPassBlending(const MethodSetup& setup, const Parts& parts);

    const gl::Program& generate() const { return m_generate; }
    const gl::Program& blend() const { return m_blend; }

  private:
    void draw_first() const;
    void draw_second() const;
    void composite() const;

    std::vector<SumTexture> m_textures;
    std::vector<gl::Texture> m_first;
    gl::Texture m_sum, m_transmittance;
    gl::Framebuffer m_first_framebuffer, m_second_framebuffer;
    gl::Program m_generate, m_blend;
    FullscreenPass m_composite;
};

}  // namespace sheer
