#pragma once
#include "renderer/passes/pass.h"
#include "renderer/passes/target.h"

namespace sheer {

/// The mean of several pictures of the target, summed in 32-bit floats and rounded once.
class FrameMean {
  public:
    FrameMean(const gl::Functions& gl, const Target& target);

    void clear() const;
    /// Adds the target's picture.
    void add() const;
    /// Writes the mean of the `count` pictures that were added to the target.
    void write(int count) const;
    std::int64_t memory_bytes() const { return m_sum.memory_bytes(); }

  private:
    const gl::Functions& m_gl;
    const Target& m_target;
    gl::Texture m_sum;
    gl::Framebuffer m_framebuffer;
    FullscreenPass m_copy;
};

}  // namespace sheer
