#pragma once
#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "renderer/gl/functions.h"

namespace sheer::gl {

/// A longer label is cut: every OpenGL 4.3 driver accepts this many bytes, and one more is an error.
inline constexpr std::size_t max_label_bytes = 255;

/// A GL object that is deleted with its owner. Move-only, labelled for debug output; must die before its context, while
/// that context is current.
template <typename Kind>
class Object {
  public:
    Object() = default;
    /// `memory_bytes` is the size of its storage, which GL itself does not report.
    Object(const Functions& gl, GLuint id, std::string_view label, std::int64_t memory_bytes = 0)
        : m_gl(&gl), m_id(id), m_memory_bytes(memory_bytes) {
        gl.ObjectLabel(Kind::identifier, id, static_cast<GLsizei>(std::min(label.size(), max_label_bytes)),
                       label.data());
    }
    Object(Object&& other) noexcept
        : m_gl(other.m_gl),
          m_id(std::exchange(other.m_id, 0)),
          m_memory_bytes(std::exchange(other.m_memory_bytes, 0)) {}
    Object& operator=(Object&& other) noexcept {
        std::swap(m_gl, other.m_gl);
        std::swap(m_id, other.m_id);
        std::swap(m_memory_bytes, other.m_memory_bytes);
        return *this;
    }
    ~Object() {
        if (m_id != 0) Kind::destroy(*m_gl, m_id);
    }

    GLuint id() const { return m_id; }
    explicit operator bool() const { return m_id != 0; }
    /// For a buffer or texture that a function below made; 0 for other objects.
    std::int64_t memory_bytes() const { return m_memory_bytes; }

  private:
    const Functions* m_gl = nullptr;
    GLuint m_id = 0;
    std::int64_t m_memory_bytes = 0;
};

/// The sum over objects, and over anything made of them that has memory_bytes().
std::int64_t memory_bytes_of(const auto&... holders) {
    return (std::int64_t{0} + ... + holders.memory_bytes());
}

struct BufferKind {
    static constexpr GLenum identifier = GL_BUFFER;
    static void destroy(const Functions& gl, GLuint id) { gl.DeleteBuffers(1, &id); }
};
struct TextureKind {
    static constexpr GLenum identifier = GL_TEXTURE;
    static void destroy(const Functions& gl, GLuint id) { gl.DeleteTextures(1, &id); }
};
struct FramebufferKind {
    static constexpr GLenum identifier = GL_FRAMEBUFFER;
    static void destroy(const Functions& gl, GLuint id) { gl.DeleteFramebuffers(1, &id); }
};
struct VertexArrayKind {
    static constexpr GLenum identifier = GL_VERTEX_ARRAY;
    static void destroy(const Functions& gl, GLuint id) { gl.DeleteVertexArrays(1, &id); }
};
struct QueryKind {
    static constexpr GLenum identifier = GL_QUERY;
    static void destroy(const Functions& gl, GLuint id) { gl.DeleteQueries(1, &id); }
};
struct ProgramKind {
    static constexpr GLenum identifier = GL_PROGRAM;
    static void destroy(const Functions& gl, GLuint id) { gl.DeleteProgram(id); }
};

using Buffer = Object<BufferKind>;
using Texture = Object<TextureKind>;
using Framebuffer = Object<FramebufferKind>;
using VertexArray = Object<VertexArrayKind>;
using Query = Object<QueryKind>;

/// An immutable buffer of `size_bytes` > 0; `data` may be null. `flags` as glNamedBufferStorage.
Buffer make_buffer(const Functions& gl, std::string_view label, GLsizeiptr size_bytes, const void* data,
                   GLbitfield flags = 0);

/// An immutable 2D texture with nearest filtering and clamped edges; change both with TextureParameteri.
Texture make_texture_2d(const Functions& gl, std::string_view label, GLenum internal_format, int width_px,
                        int height_px, int levels = 1);
/// One of `samples` samples per pixel, at fixed places.
Texture make_texture_2d_multisample(const Functions& gl, std::string_view label, GLenum internal_format, int width_px,
                                    int height_px, int samples);

/// For a sized internal format. Throws std::logic_error for one that no texture here uses.
int bytes_per_texel(GLenum internal_format);

/// A framebuffer with the given color textures (0..n-1) and depth texture (0 for none; one with
/// stencil bits is the stencil attachment too). It draws to all of its color textures.
/// Throws RenderError naming `label` if it is not complete.
Framebuffer make_framebuffer(const Functions& gl, std::string_view label, std::span<const GLuint> colors, GLuint depth);

VertexArray make_vertex_array(const Functions& gl, std::string_view label);
Query make_query(const Functions& gl, std::string_view label, GLenum target);

/// The first texture unit for textures that are set by name. The units below it belong to the scene, whose shaders
/// choose them with layout(binding).
inline constexpr GLuint first_named_texture_unit = 8;

/// A linked program. Throws RenderError with the driver's log, naming `label` and the stage, if it does not build.
class Program {
  public:
    Program() = default;
    Program(const Functions& gl, std::string_view label, std::string_view vertex_source,
            std::string_view fragment_source);
    /// One with a compute stage alone.
    static Program compute(const Functions& gl, std::string_view label, std::string_view source);

    GLuint id() const { return m_object.id(); }
    void use() const;

    const std::string& fragment_source() const { return m_fragment_source; }
    /// A program with the same vertex stage. Throws RenderError like the constructor.
    Program with_fragment_source(std::string_view label, std::string_view fragment_source) const;
    /// Gives each uniform that both programs have, including texture units, the value that it has in `other`. Throws
    /// std::logic_error naming one whose type OpenGL 4.5 does not have.
    void copy_uniforms(const Program& other) const;

    /// Sets a uniform by name; one that the compiler removed is ignored.
    void set(const char* name, int value) const;
    void set(const char* name, unsigned value) const;
    void set(const char* name, float value) const;
    void set(const char* name, const glm::vec2& value) const;
    void set(const char* name, const glm::vec3& value) const;
    void set(const char* name, const glm::vec4& value) const;
    void set(const char* name, const glm::mat4& value) const;

    /// Binds a texture to the sampler of this name, for the draws that follow until a texture is set on another
    /// program. The program chooses the unit; its shaders do not name one. A sampler that the compiler removed is
    /// ignored.
    void set_texture(const char* name, const Texture& texture) const;

  private:
    void link(std::string_view label, std::initializer_list<GLuint> shaders);
    void copy_element(const Program& other, const std::string& name, GLenum type) const;

    const Functions* m_gl = nullptr;
    Object<ProgramKind> m_object;
    std::string m_vertex_source, m_fragment_source;
    mutable std::vector<std::string> m_samplers;  ///< by texture unit, from first_named_texture_unit on
};

/// The text of a file below shaders/, with a #line so that errors in it are reported with its path and its own lines.
/// Throws std::out_of_range naming the path if there is none.
std::string shader_file(std::string_view path);

}  // namespace sheer::gl
