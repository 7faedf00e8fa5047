#pragma once
#include "renderer/gl/objects.h"
#include "renderer/image/pixel_counts.h"

namespace sheer {

/// A counter for each pixel of the target, to which fragment shaders add with imageAtomicAdd on image unit 0.
class CountImage {
  public:
    CountImage(const gl::Functions& gl, std::string_view label, int width_px, int height_px);

    int width_px() const { return m_width_px; }
    int height_px() const { return m_height_px; }
    void clear() const;
    void bind() const;
    /// Waits for the device.
    PixelCounts read() const;

  private:
    const gl::Functions& m_gl;
    int m_width_px, m_height_px;
    gl::Texture m_texture;
};

}  // namespace sheer
