#pragma once
#include <algorithm>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "renderer/gl/functions.h"

namespace sheer::gl {

/// A longer label is cut: every OpenGL 4.3 driver takes this many bytes, and one too many is an error.
inline constexpr std::size_t max_label_bytes = 255;

/// A GL object that is deleted with its owner. Move-only, labelled for debug output; must die before its context, while
/// that context is current.
template <typename Kind>
class Object {
  public:
    Object() = default;
    Object(const Functions& gl, GLuint id, std::string_view label) : m_gl(&gl), m_id(id) {
        gl.ObjectLabel(Kind::identifier, id, static_cast<GLsizei>(std::min(label.size(), max_label_bytes)),
                       label.data());
    }
    Object(Object&& other) noexcept : m_gl(other.m_gl), m_id(std::exchange(other.m_id, 0)) {}
    Object& operator=(Object&& other) noexcept {
        std::swap(m_gl, other.m_gl);
        std::swap(m_id, other.m_id);
        return *this;
    }
    ~Object() {
        if (m_id != 0) Kind::destroy(*m_gl, m_id);
    }

    GLuint id() const { return m_id; }
    explicit operator bool() const { return m_id != 0; }

  private:
    const Functions* m_gl = nullptr;
    GLuint m_id = 0;
};

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

/// A framebuffer with the given colour textures (0..n-1) and depth texture (0 for none; one with
/// stencil bits is the stencil attachment too). It draws to all of its colour textures.
/// Throws RenderError naming `label` if it is not complete.
Framebuffer make_framebuffer(const Functions& gl, std::string_view label, std::span<const GLuint> colors, GLuint depth);

VertexArray make_vertex_array(const Functions& gl, std::string_view label);
Query make_query(const Functions& gl, std::string_view label, GLenum target);

/// A linked program. Throws RenderError with the driver's log, naming `label` and the stage, if it does not build.
class Program {
  public:
    Program() = default;
    Program(const Functions& gl, std::string_view label, std::string_view vertex_source,
            std::string_view fragment_source);

    GLuint id() const { return m_object.id(); }
    void use() const;

    const std::string& fragment_source() const { return m_fragment_source; }
    /// A program with the same vertex stage. Throws RenderError like the constructor.
    Program with_fragment_source(std::string_view label, std::string_view fragment_source) const;
    /// Gives each uniform that both programs have the value that it has in `other`.
    void copy_uniforms(const Program& other) const;

    /// Sets a uniform by name; one that the compiler removed is passed over.
    void set(const char* name, int value) const;
    void set(const char* name, unsigned value) const;
    void set(const char* name, float value) const;
    void set(const char* name, const glm::vec2& value) const;
    void set(const char* name, const glm::vec3& value) const;
    void set(const char* name, const glm::vec4& value) const;
    void set(const char* name, const glm::mat4& value) const;

  private:
    const Functions* m_gl = nullptr;
    Object<ProgramKind> m_object;
    std::string m_vertex_source, m_fragment_source;
};

/// The text of a file below shaders/. Throws std::out_of_range naming the path if there is none.
std::string_view shader_file(std::string_view path);

}  // namespace sheer::gl
