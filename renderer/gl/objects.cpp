#include "renderer/gl/objects.h"

#include <embedded_shaders.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <glm/gtc/type_ptr.hpp>
#include <stdexcept>

#include "renderer/errors.h"

namespace sheer::gl {
namespace {

struct ShaderKind {
    static constexpr GLenum identifier = GL_SHADER;
    static void destroy(const Functions& gl, GLuint id) { gl.DeleteShader(id); }
};
using Shader = Object<ShaderKind>;

std::string_view stage_name(GLenum stage) {
    return stage == GL_VERTEX_SHADER ? "vertex" : "fragment";
}

using GetParameter = PFNGLGETSHADERIVPROC;
using GetLog = PFNGLGETSHADERINFOLOGPROC;

/// The driver's log of a shader or a program, which share these signatures.
std::string info_log(GetParameter get_parameter, GetLog get_log, GLuint id) {
    GLint size = 0;
    get_parameter(id, GL_INFO_LOG_LENGTH, &size);
    if (size <= 1) return "(the driver gave no log)";
    std::string log(static_cast<std::size_t>(size), '\0');
    GLsizei length = 0;
    get_log(id, size, &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    return log;
}

Shader compile(const Functions& gl, std::string_view label, GLenum stage, std::string_view source) {
    Shader shader(gl, gl.CreateShader(stage), fmt::format("{} ({} shader)", label, stage_name(stage)));
    const GLchar* text = source.data();
    const auto size = static_cast<GLint>(source.size());
    gl.ShaderSource(shader.id(), 1, &text, &size);
    gl.CompileShader(shader.id());
    GLint compiled = GL_FALSE;
    gl.GetShaderiv(shader.id(), GL_COMPILE_STATUS, &compiled);
    if (compiled == GL_FALSE) {
        throw RenderError(fmt::format("program '{}': the {} shader does not compile:\n{}", label, stage_name(stage),
                                      info_log(gl.GetShaderiv, gl.GetShaderInfoLog, shader.id())));
    }
    return shader;
}

std::string status_name(GLenum status) {
    switch (status) {
        case GL_FRAMEBUFFER_UNDEFINED:
            return "it is undefined";
        case GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT:
            return "an attachment cannot be rendered to";
        case GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT:
            return "it has no attachment";
        case GL_FRAMEBUFFER_INCOMPLETE_DRAW_BUFFER:
            return "a draw buffer has no attachment";
        case GL_FRAMEBUFFER_INCOMPLETE_READ_BUFFER:
            return "the read buffer has no attachment";
        case GL_FRAMEBUFFER_UNSUPPORTED:
            return "the driver does not support these formats together";
        case GL_FRAMEBUFFER_INCOMPLETE_MULTISAMPLE:
            return "the attachments differ in their samples";
        case GL_FRAMEBUFFER_INCOMPLETE_LAYER_TARGETS:
            return "the attachments differ in their layers";
        default:
            return fmt::format("status {:#06x}", status);
    }
}

/// Where a depth texture goes: with its stencil if it has one.
GLenum depth_attachment(const Functions& gl, GLuint texture) {
    GLint stencil_bits = 0;
    gl.GetTextureLevelParameteriv(texture, 0, GL_TEXTURE_STENCIL_SIZE, &stencil_bits);
    GLint depth_bits = 0;
    gl.GetTextureLevelParameteriv(texture, 0, GL_TEXTURE_DEPTH_SIZE, &depth_bits);
    if (stencil_bits == 0) return GL_DEPTH_ATTACHMENT;
    return depth_bits == 0 ? GL_STENCIL_ATTACHMENT : GL_DEPTH_STENCIL_ATTACHMENT;
}

/// Block members have no location and are passed over.
void copy_uniform(const Functions& gl, GLuint from, GLuint to, const char* name, GLenum type) {
    const GLint source = gl.GetUniformLocation(from, name), target = gl.GetUniformLocation(to, name);
    if (source < 0 || target < 0) return;
    std::array<GLfloat, 16> floats{};
    GLint integer = 0;
    switch (type) {
        case GL_FLOAT:
        case GL_FLOAT_VEC2:
        case GL_FLOAT_VEC3:
        case GL_FLOAT_VEC4:
        case GL_FLOAT_MAT4:
            gl.GetUniformfv(from, source, floats.data());
            break;
        default:  // samplers, of which there are many types, are integers
            gl.GetUniformiv(from, source, &integer);
    }
    switch (type) {
        case GL_FLOAT:
            return gl.ProgramUniform1fv(to, target, 1, floats.data());
        case GL_FLOAT_VEC2:
            return gl.ProgramUniform2fv(to, target, 1, floats.data());
        case GL_FLOAT_VEC3:
            return gl.ProgramUniform3fv(to, target, 1, floats.data());
        case GL_FLOAT_VEC4:
            return gl.ProgramUniform4fv(to, target, 1, floats.data());
        case GL_FLOAT_MAT4:
            return gl.ProgramUniformMatrix4fv(to, target, 1, GL_FALSE, floats.data());
        case GL_UNSIGNED_INT:
            return gl.ProgramUniform1ui(to, target, static_cast<GLuint>(integer));
        default:
            return gl.ProgramUniform1i(to, target, integer);
    }
}

}  // namespace

Buffer make_buffer(const Functions& gl, std::string_view label, GLsizeiptr size_bytes, const void* data,
                   GLbitfield flags) {
    GLuint id = 0;
    gl.CreateBuffers(1, &id);
    Buffer buffer(gl, id, label);
    gl.NamedBufferStorage(id, size_bytes, data, flags);
    return buffer;
}

Texture make_texture_2d(const Functions& gl, std::string_view label, GLenum internal_format, int width_px,
                        int height_px, int levels) {
    GLuint id = 0;
    gl.CreateTextures(GL_TEXTURE_2D, 1, &id);
    Texture texture(gl, id, label);
    gl.TextureStorage2D(id, levels, internal_format, width_px, height_px);
    gl.TextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl.TextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl.TextureParameteri(id, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl.TextureParameteri(id, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    return texture;
}

Framebuffer make_framebuffer(const Functions& gl, std::string_view label, std::span<const GLuint> colors,
                             GLuint depth) {
    GLuint id = 0;
    gl.CreateFramebuffers(1, &id);
    Framebuffer framebuffer(gl, id, label);
    std::vector<GLenum> draw_buffers;
    for (GLuint color : colors) {
        const GLenum attachment = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(draw_buffers.size());
        gl.NamedFramebufferTexture(id, attachment, color, 0);
        draw_buffers.push_back(attachment);
    }
    // The initial draw and read buffers name attachment 0, which a depth-only framebuffer lacks.
    if (colors.empty()) gl.NamedFramebufferReadBuffer(id, GL_NONE);
    gl.NamedFramebufferDrawBuffers(id, static_cast<GLsizei>(draw_buffers.size()), draw_buffers.data());
    if (depth != 0) gl.NamedFramebufferTexture(id, depth_attachment(gl, depth), depth, 0);
    const GLenum status = gl.CheckNamedFramebufferStatus(id, GL_DRAW_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        throw RenderError(fmt::format("framebuffer '{}' is not complete: {}", label, status_name(status)));
    }
    return framebuffer;
}

VertexArray make_vertex_array(const Functions& gl, std::string_view label) {
    GLuint id = 0;
    gl.CreateVertexArrays(1, &id);
    return VertexArray(gl, id, label);
}

Query make_query(const Functions& gl, std::string_view label, GLenum target) {
    GLuint id = 0;
    gl.CreateQueries(target, 1, &id);
    return Query(gl, id, label);
}

Program::Program(const Functions& gl, std::string_view label, std::string_view vertex_source,
                 std::string_view fragment_source)
    : m_gl(&gl), m_vertex_source(vertex_source), m_fragment_source(fragment_source) {
    const Shader vertex = compile(gl, label, GL_VERTEX_SHADER, vertex_source);
    const Shader fragment = compile(gl, label, GL_FRAGMENT_SHADER, fragment_source);
    m_object = Object<ProgramKind>(gl, gl.CreateProgram(), label);
    for (GLuint shader : {vertex.id(), fragment.id()}) gl.AttachShader(id(), shader);
    gl.LinkProgram(id());
    for (GLuint shader : {vertex.id(), fragment.id()}) gl.DetachShader(id(), shader);
    GLint linked = GL_FALSE;
    gl.GetProgramiv(id(), GL_LINK_STATUS, &linked);
    if (linked == GL_FALSE) {
        throw RenderError(fmt::format("program '{}': the stages do not link:\n{}", label,
                                      info_log(gl.GetProgramiv, gl.GetProgramInfoLog, id())));
    }
}

void Program::use() const {
    m_gl->UseProgram(id());
}

Program Program::with_fragment_source(std::string_view label, std::string_view fragment_source) const {
    return Program(*m_gl, label, m_vertex_source, fragment_source);
}

void Program::copy_uniforms(const Program& other) const {
    GLint count = 0;
    m_gl->GetProgramiv(other.id(), GL_ACTIVE_UNIFORMS, &count);
    for (GLuint index = 0; index < static_cast<GLuint>(count); ++index) {
        std::array<GLchar, 256> name{};
        GLint size = 0;
        GLenum type = 0;
        m_gl->GetActiveUniform(other.id(), index, static_cast<GLsizei>(name.size()), nullptr, &size, &type,
                               name.data());
        copy_uniform(*m_gl, other.id(), id(), name.data(), type);
    }
}

// GL passes over location -1, which is what a uniform that the compiler removed has.
void Program::set(const char* name, int value) const {
    m_gl->ProgramUniform1i(id(), m_gl->GetUniformLocation(id(), name), value);
}

void Program::set(const char* name, unsigned value) const {
    m_gl->ProgramUniform1ui(id(), m_gl->GetUniformLocation(id(), name), value);
}

void Program::set(const char* name, float value) const {
    m_gl->ProgramUniform1f(id(), m_gl->GetUniformLocation(id(), name), value);
}

void Program::set(const char* name, const glm::vec2& value) const {
    m_gl->ProgramUniform2fv(id(), m_gl->GetUniformLocation(id(), name), 1, glm::value_ptr(value));
}

void Program::set(const char* name, const glm::vec3& value) const {
    m_gl->ProgramUniform3fv(id(), m_gl->GetUniformLocation(id(), name), 1, glm::value_ptr(value));
}

void Program::set(const char* name, const glm::vec4& value) const {
    m_gl->ProgramUniform4fv(id(), m_gl->GetUniformLocation(id(), name), 1, glm::value_ptr(value));
}

void Program::set(const char* name, const glm::mat4& value) const {
    m_gl->ProgramUniformMatrix4fv(id(), m_gl->GetUniformLocation(id(), name), 1, GL_FALSE, glm::value_ptr(value));
}

std::string_view shader_file(std::string_view path) {
    const auto files = embedded_shaders();
    const auto file = std::ranges::find(files, path, &EmbeddedFile::path);
    if (file == files.end()) throw std::out_of_range(fmt::format("there is no shader file '{}'", path));
    return file->bytes;
}

}  // namespace sheer::gl
