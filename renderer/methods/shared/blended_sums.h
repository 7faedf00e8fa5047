#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "renderer/methods/shared/method.h"

namespace sheer {

/// A texture into which fragments are blended, in any order.
struct SumTexture {
    std::string name;  ///< the composite's sampler is "u_" and this
    GLenum format = GL_RGBA16F;
    float empty = 0;  ///< each channel before the first fragment
    GLenum source_factor = GL_ONE, target_factor = GL_ONE;
};

/// 16-bit floats as in the sources, or 32-bit ones if the image is.
GLenum four_channel_sums(const Target& target);
GLenum one_channel_sums(const Target& target);

/// A method that draws the transparent fragments once, in any order, into textures that are blended additively or
/// multiplicatively, and then composites these with the opaque picture.
///
/// The composite's shader gets the textures by their names and the opaque picture as u_opaque. It discards where no
/// fragment counts, so that the opaque picture stays there without being rounded again.
class BlendedSums : public OpaqueFirst {
  public:
    struct Parts {
        std::string label;                       ///< of GL objects
        std::vector<SumTexture> textures;        ///< color output 0 of `accumulate`, 1, ...
        std::string_view accumulate, composite;  ///< paths below shaders/
        std::string prolog = {};                 ///< of both shaders
    };

    void render(gl::FrameTimer& timer) override;
    std::int64_t memory_bytes() const override;

  protected:
    BlendedSums(const MethodSetup& setup, const Parts& parts);

    const gl::Program& accumulate() const { return m_accumulate; }
    const FullscreenPass& composite() const { return m_composite; }
    /// A pixel of the texture at this place of Parts::textures. Waits for the device.
    glm::vec4 sum_at(const PixelTrace& trace, std::size_t texture) const;
    /// The composite's outputs at the pixel. Waits for the device.
    glm::vec4 composite_at(const PixelTrace& trace, int output) const;
    /// All pixels of that texture. Waits for the device.
    std::vector<glm::vec4> read_sum(std::size_t texture) const;

  private:
    void clear() const;
    void set_textures() const;

    std::vector<SumTexture> m_textures;
    std::vector<gl::Texture> m_sums;
    gl::Framebuffer m_framebuffer;
    gl::Program m_accumulate;
    FullscreenPass m_composite;
};

}  // namespace sheer
