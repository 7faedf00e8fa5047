#pragma once
#include "renderer/image/pixel_counts.h"
#include "renderer/passes/pass.h"
#include "renderer/passes/target.h"

namespace sheer {

/// Takes the transparent fragments of a scene layer by layer, from near to far, without sorting (Everitt, Interactive
/// Order-Independent Transparency, NVIDIA 2001). Fragments of equal depth are distinguished by their primitive, so that
/// none is lost; the one submitted later is nearer. The target's depth is that of the opaque pass.
class DepthPeeler {
  public:
    DepthPeeler(const gl::Functions& gl, const Scene& scene, const Target& target);

    /// Goes to the front of the first layer.
    void begin();
    /// Draws the next layer; false if no fragment was left. Waits for the device.
    bool next();
    /// The shaded color of the layer that next() drew, in 32-bit floats; 0 where the pixel has no fragment left.
    const gl::Texture& color() const { return m_layers[m_current].color; }
    /// Its depth, 0..1; 2 where the pixel has no fragment left.
    const gl::Texture& depth() const { return m_layers[m_current].depth; }
    std::int64_t memory_bytes() const;

  private:
    struct Layer {
        gl::Texture color, depth, primitive;
        gl::Framebuffer framebuffer;
    };
    gl::Texture texture(const std::string& what, GLenum format) const;
    Pass begin_layer(const Layer& layer, float depth) const;

    const gl::Functions& m_gl;
    const Scene& m_scene;
    const Target& m_target;
    gl::Program m_peel;
    gl::Query m_any_fragment;
    gl::Texture m_depth;
    Layer m_layers[2];
    int m_current = 0;
};

/// How many fragments peeling draws: all of them, once for each layer of the deepest pixel and once to find no more.
double peeled_fragments(const PixelCounts& overdraw);

/// As many as take seconds on a software rasteriser.
inline constexpr double max_peeled_fragments = 4e8;

}  // namespace sheer
