#pragma once
#include <vector>

#include "renderer/passes/target.h"

namespace sheer {

/// A picture of the target's size and format with several samples per pixel, and its own depth, to be resolved into the
/// target.
class Multisample {
  public:
    /// Takes the lowest number of samples from `samples` up that the device has. Throws Unsupported if it has only
    /// fewer.
    Multisample(const gl::Functions& gl, const Target& target, int samples);

    const gl::Framebuffer& framebuffer() const { return m_framebuffer; }
    const gl::Texture& color() const { return m_color; }
    const gl::Texture& depth() const { return m_depth; }
    int samples() const { return m_samples; }
    struct Sample {
        glm::vec4 color{};
        float depth = 1;
    };
    /// The samples of a pixel. Waits for the device.
    std::vector<Sample> read(int x, int y) const;
    /// The mean of each pixel's samples becomes the target's color; its depth stays.
    void resolve_color() const;
    std::int64_t memory_bytes() const { return gl::memory_bytes_of(m_color, m_depth); }

  private:
    const gl::Functions& m_gl;
    const Target& m_target;
    int m_samples;
    gl::Texture m_color, m_depth;
    gl::Framebuffer m_framebuffer;
};

}  // namespace sheer
