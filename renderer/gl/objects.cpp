#include "renderer/gl/objects.h"

#include <embedded_shaders.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <glm/gtc/type_ptr.hpp>
#include <regex>
#include <stdexcept>

#include "renderer/core/errors.h"
#include "renderer/gl/copy_uniform.h"

namespace sheer::gl {
namespace {

struct ShaderKind {
    static constexpr GLenum identifier = GL_SHADER;
    static void destroy(const Functions& gl, GLuint id) { gl.DeleteShader(id); }
};
using Shader = Object<ShaderKind>;

std::string_view stage_name(GLenum stage) {
    switch (stage) {
        case GL_VERTEX_SHADER:
            return "vertex";
        case GL_FRAGMENT_SHADER:
            return "fragment";
        default:
            return "compute";
    }
}

using GetParameter = PFNGLGETSHADERIVPROC;
using GetLog = PFNGLGETSHADERINFOLOGPROC;

/// In what the driver compiles, lines of shader files are numbered from here on, each file with a range of its own.
/// (Mesa ignores the source string number of #line, which is meant for telling files apart.)
constexpr int first_file_line = 1'000'000, lines_of_a_file = 10'000;

int first_line_of(std::size_t file) {
    return first_file_line + static_cast<int>(file) * lines_of_a_file + 1;
}

/// "shaders/methods/f2bd.glsl:12" for the number of such a line; "" for any other number.
std::string file_and_line(long line) {
    const auto files = embedded_shaders();
    if (line < first_file_line) return "";
    const auto file = static_cast<std::size_t>((line - first_file_line) / lines_of_a_file);
    if (file >= files.size()) return "";
    return fmt::format("shaders/{}:{}", files[file].path, (line - first_file_line) % lines_of_a_file);
}

/// The log with "shaders/methods/f2bd.glsl:12" for "0:1230012" (Mesa, AMD) and "0(1230012)" (NVIDIA).
std::string with_file_names(const std::string& log) {
    static const std::regex place(R"(\b0[:(](\d{7,9})\)?)");
    std::string named;
    std::size_t done = 0;
    for (std::sregex_iterator match(log.begin(), log.end(), place), end; match != end; ++match) {
        const std::string file = file_and_line(std::stol((*match)[1]));
        if (file.empty()) continue;
        const auto at = static_cast<std::size_t>(match->position());
        named += log.substr(done, at - done) + file;
        done = at + static_cast<std::size_t>(match->length());
    }
    return named + log.substr(done);
}

/// The driver's log of a shader or a program, which share these signatures.
std::string info_log(GetParameter get_parameter, GetLog get_log, GLuint id) {
    GLint size = 0;
    get_parameter(id, GL_INFO_LOG_LENGTH, &size);
    if (size <= 1) return "(the driver gave no log)";
    std::string log(static_cast<std::size_t>(size), '\0');
    GLsizei length = 0;
    get_log(id, size, &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    return with_file_names(log);
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

/// The attachment point of a depth texture, which includes its stencil if it has one.
GLenum depth_attachment(const Functions& gl, GLuint texture) {
    GLint stencil_bits = 0;
    gl.GetTextureLevelParameteriv(texture, 0, GL_TEXTURE_STENCIL_SIZE, &stencil_bits);
    GLint depth_bits = 0;
    gl.GetTextureLevelParameteriv(texture, 0, GL_TEXTURE_DEPTH_SIZE, &depth_bits);
    if (stencil_bits == 0) return GL_DEPTH_ATTACHMENT;
    return depth_bits == 0 ? GL_STENCIL_ATTACHMENT : GL_DEPTH_STENCIL_ATTACHMENT;
}

/// GL names an array by its first element.
std::string element_name(std::string_view name, GLint element) {
    if (!name.ends_with("[0]")) return std::string(name);
    return fmt::format("{}[{}]", name.substr(0, name.size() - 3), element);
}

}  // namespace

Buffer make_buffer(const Functions& gl, std::string_view label, GLsizeiptr size_bytes, const void* data,
                   GLbitfield flags) {
    GLuint id = 0;
    gl.CreateBuffers(1, &id);
    Buffer buffer(gl, id, label, size_bytes);
    gl.NamedBufferStorage(id, size_bytes, data, flags);
    return buffer;
}

Texture make_texture_2d(const Functions& gl, std::string_view label, GLenum internal_format, int width_px,
                        int height_px, int levels) {
    GLuint id = 0;
    gl.CreateTextures(GL_TEXTURE_2D, 1, &id);
    std::int64_t texels = 0;
    for (int level = 0; level < levels; ++level)
        texels += std::int64_t{std::max(width_px >> level, 1)} * std::max(height_px >> level, 1);
    Texture texture(gl, id, label, texels * bytes_per_texel(internal_format));
    gl.TextureStorage2D(id, levels, internal_format, width_px, height_px);
    gl.TextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl.TextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl.TextureParameteri(id, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl.TextureParameteri(id, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    return texture;
}

Texture make_texture_2d_multisample(const Functions& gl, std::string_view label, GLenum internal_format, int width_px,
                                    int height_px, int samples) {
    GLuint id = 0;
    gl.CreateTextures(GL_TEXTURE_2D_MULTISAMPLE, 1, &id);
    const std::int64_t texels = std::int64_t{width_px} * height_px * samples;
    Texture texture(gl, id, label, texels * bytes_per_texel(internal_format));
    gl.TextureStorage2DMultisample(id, samples, internal_format, width_px, height_px, GL_TRUE);
    return texture;
}

int bytes_per_texel(GLenum internal_format) {
    switch (internal_format) {
        case GL_R8:
            return 1;
        case GL_R16F:
        case GL_DEPTH_COMPONENT16:
            return 2;
        case GL_RGBA8:
        case GL_R32F:
        case GL_R32UI:
        case GL_RGB9_E5:
        case GL_DEPTH_COMPONENT24:
        case GL_DEPTH_COMPONENT32F:
        case GL_DEPTH24_STENCIL8:
            return 4;
        case GL_RGBA16F:
        case GL_RG32F:
        case GL_DEPTH32F_STENCIL8:
            return 8;
        case GL_RGBA32F:
            return 16;
        default:
            throw std::logic_error(fmt::format("the size of format {:#06x} is not known", internal_format));
    }
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
    link(label, {vertex.id(), fragment.id()});
}

Program Program::compute(const Functions& gl, std::string_view label, std::string_view source) {
    const Shader shader = compile(gl, label, GL_COMPUTE_SHADER, source);
    Program program;
    program.m_gl = &gl;
    program.link(label, {shader.id()});
    return program;
}

void Program::link(std::string_view label, std::initializer_list<GLuint> shaders) {
    const Functions& gl = *m_gl;
    m_object = Object<ProgramKind>(gl, gl.CreateProgram(), label);
    for (GLuint shader : shaders) gl.AttachShader(id(), shader);
    gl.LinkProgram(id());
    for (GLuint shader : shaders) gl.DetachShader(id(), shader);
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
    GLint count = 0, longest = 0;
    m_gl->GetProgramiv(other.id(), GL_ACTIVE_UNIFORMS, &count);
    m_gl->GetProgramiv(other.id(), GL_ACTIVE_UNIFORM_MAX_LENGTH, &longest);
    std::vector<GLchar> name(static_cast<std::size_t>(longest) + 1);
    for (GLuint index = 0; index < static_cast<GLuint>(count); ++index) {
        GLint size = 0;
        GLenum type = 0;
        m_gl->GetActiveUniform(other.id(), index, static_cast<GLsizei>(name.size()), nullptr, &size, &type,
                               name.data());
        for (GLint element = 0; element < size; ++element)
            copy_element(other, element_name(name.data(), element), type);
    }
    m_samplers = other.m_samplers;
}

void Program::copy_element(const Program& other, const std::string& name, GLenum type) const {
    const UniformPlace from{other.id(), m_gl->GetUniformLocation(other.id(), name.c_str())};
    const UniformPlace to{id(), m_gl->GetUniformLocation(id(), name.c_str())};
    // Members of blocks have no location.
    if (from.location >= 0 && to.location >= 0) copy_uniform(*m_gl, from, to, name, type);
}

void Program::set_texture(const char* name, const Texture& texture) const {
    const GLint location = m_gl->GetUniformLocation(id(), name);
    if (location < 0) return;
    const auto known = std::ranges::find(m_samplers, name);
    const auto unit = first_named_texture_unit + static_cast<GLuint>(known - m_samplers.begin());
    if (known == m_samplers.end()) {
        m_samplers.emplace_back(name);
        m_gl->ProgramUniform1i(id(), location, static_cast<GLint>(unit));
    }
    m_gl->BindTextureUnit(unit, texture.id());
}

// GL ignores location -1, the location of a uniform that the compiler removed.
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

std::string shader_file(std::string_view path) {
    const auto files = embedded_shaders();
    const auto file = std::ranges::find(files, path, &EmbeddedFile::path);
    if (file == files.end()) throw std::out_of_range(fmt::format("there is no shader file '{}'", path));
    const std::string_view text = file->bytes;
    const int first = first_line_of(static_cast<std::size_t>(file - files.begin()));
    // Nothing may come before #version.
    if (!text.starts_with("#version")) return fmt::format("#line {}\n{}", first, text);
    const std::size_t second = text.find('\n') + 1;
    return fmt::format("{}#line {}\n{}", text.substr(0, second), first + 1, text.substr(second));
}

}  // namespace sheer::gl
