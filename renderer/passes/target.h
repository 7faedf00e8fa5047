#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "renderer/gl/objects.h"
#include "renderer/gl/timer.h"
#include "renderer/image/image.h"
#include "renderer/image/image_spec.h"
#include "renderer/scene/scene.h"

namespace sheer {

/// The picture that methods render into: color in the spec's format, depth in 32-bit floats. Row 0 is the top row.
class Target {
  public:
    Target(const gl::Functions& gl, const ImageSpec& image, PixelFormat format);

    int width_px() const { return m_image.width_px; }
    int height_px() const { return m_image.height_px; }
    glm::vec3 background() const { return {m_image.background[0], m_image.background[1], m_image.background[2]}; }
    /// For the frames from now on; what a method keeps of earlier frames must be cleared by Method::restart.
    void set_background(const std::array<float, 3>& background) { m_image.background = background; }
    PixelFormat format() const { return m_format; }
    const gl::Framebuffer& framebuffer() const { return m_framebuffer; }
    const gl::Texture& color() const { return m_color; }
    const gl::Texture& depth() const { return m_depth; }

    /// Another texture of the same size.
    gl::Texture make_texture(std::string_view label, GLenum internal_format) const {
        return gl::make_texture_2d(m_gl, label, internal_format, width_px(), height_px());
    }

    /// Waits for the device and copies the picture.
    Image read() const;

  private:
    const gl::Functions& m_gl;
    ImageSpec m_image;
    PixelFormat m_format;
    gl::Texture m_color, m_depth;
    gl::Framebuffer m_framebuffer;
};

/// GL internal format of a four-channel picture.
GLenum gl_format(PixelFormat format);

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
