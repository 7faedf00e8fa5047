#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "renderer/frame/image.h"
#include "renderer/gl/objects.h"
#include "renderer/gl/timer.h"
#include "renderer/scene/scene.h"
#include "renderer/spec/spec.h"

namespace sheer {

/// The picture that methods render into: colour in the spec's format, depth in 32-bit floats. Row 0 is the top row.
class Target {
  public:
    Target(const gl::Functions& gl, const ImageSpec& image, PixelFormat format);

    int width_px() const { return m_image.width_px; }
    int height_px() const { return m_image.height_px; }
    glm::vec3 background() const { return {m_image.background[0], m_image.background[1], m_image.background[2]}; }
    /// Of the frames from now on; what is left of earlier ones in a method is its own to forget (Method::restart).
    void set_background(const std::array<float, 3>& background) { m_image.background = background; }
    PixelFormat format() const { return m_format; }
    const gl::Framebuffer& framebuffer() const { return m_framebuffer; }
    const gl::Texture& color() const { return m_color; }
    const gl::Texture& depth() const { return m_depth; }

    /// Waits for the device and copies the picture.
    Image read() const;

  private:
    const gl::Functions& m_gl;
    ImageSpec m_image;
    PixelFormat m_format;
    gl::Texture m_color, m_depth;
    gl::Framebuffer m_framebuffer;
};

/// GL internal format and bytes per pixel of a four-channel picture.
GLenum gl_format(PixelFormat format);
int bytes_per_pixel(PixelFormat format);

/// Binds `framebuffer` for drawing over the whole target, and puts the state that passes vary back to: no blending,
/// no depth or stencil test, depth and colour writes on, no culling, no scissor, no alpha to coverage, origin top left,
/// depth 0..1. Every pass begins with it and then sets what it needs.
void begin_pass(const gl::Functions& gl, const gl::Framebuffer& framebuffer, int width_px, int height_px);

/// Transparent primitives: hidden behind opaque ones, not by each other. (LEQUAL, no depth writes.)
void set_transparent_depth_state(const gl::Functions& gl);

/// First pass of most methods: clears to the background and draws the opaque primitives with depth.
class OpaquePass {
  public:
    OpaquePass(const gl::Functions& gl, const Scene& scene, const Target& target);
    void draw(gl::FrameTimer& timer) const { draw_into(m_target.framebuffer(), timer); }
    /// Into another framebuffer of the target's size, such as one with several samples per pixel.
    void draw_into(const gl::Framebuffer& framebuffer, gl::FrameTimer& timer) const;

  private:
    const gl::Functions& m_gl;
    const Scene& m_scene;
    const Target& m_target;
    gl::Program m_program;
};

/// A triangle over the whole target, with a fragment program of its own.
class FullscreenPass {
  public:
    /// `source` is GLSL after #version and `prolog`.
    FullscreenPass(const gl::Functions& gl, std::string_view label, std::string_view source,
                   const std::string& prolog = {});
    const gl::Program& program() const { return m_program; }
    void draw() const;

  private:
    const gl::Functions& m_gl;
    gl::Program m_program;
    gl::VertexArray m_vertex_array;
};

}  // namespace sheer
