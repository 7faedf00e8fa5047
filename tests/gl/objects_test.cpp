#include "renderer/gl/objects.h"

#include <embedded_shaders.h>

#include <fstream>
#include <functional>
#include <glm/gtc/type_ptr.hpp>
#include <iterator>
#include <map>
#include <stdexcept>

#include "renderer/gl/copy_uniform.h"
#include "tests/gl/gl_test.h"
#include "tests/source_folder.h"

namespace sheer::gl::objects_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class EachObjectContext : public EachContext {
  protected:
    std::string label_of(GLenum identifier, GLuint id) {
        std::array<GLchar, 512> label{};
        gl().GetObjectLabel(identifier, id, static_cast<GLsizei>(label.size()), nullptr, label.data());
        return label.data();
    }
    void TearDown() override {
        if (m_context != nullptr) context().check("the test");
    }
};

INSTANTIATE_TEST_SUITE_P(Gl, EachObjectContext, every_context, context_name);

constexpr std::string_view white_fragment_shader = R"(#version 450
layout(location = 0) out vec4 color;  // no blending
void main() { color = vec4(1.0); }
)";

TEST_P(EachObjectContext, AreLabelled) {
    const Buffer buffer = make_buffer(gl(), "a buffer", 4, nullptr);
    const Target target(gl(), 1);
    const VertexArray vertices = make_vertex_array(gl(), "a vertex array");
    const Query query = make_query(gl(), "a query", GL_SAMPLES_PASSED);
    const Program program(gl(), "a program", full_screen_vertex_shader, white_fragment_shader);
    EXPECT_EQ(label_of(GL_BUFFER, buffer.id()), "a buffer");
    EXPECT_EQ(label_of(GL_TEXTURE, target.color.id()), "target");
    EXPECT_EQ(label_of(GL_FRAMEBUFFER, target.framebuffer.id()), "target");
    EXPECT_EQ(label_of(GL_VERTEX_ARRAY, vertices.id()), "a vertex array");
    EXPECT_EQ(label_of(GL_QUERY, query.id()), "a query");
    EXPECT_EQ(label_of(GL_PROGRAM, program.id()), "a program");
}

TEST_P(EachObjectContext, ALongLabelIsCut) {
    const Buffer buffer = make_buffer(gl(), std::string(5000, 'x'), 4, nullptr);
    EXPECT_EQ(label_of(GL_BUFFER, buffer.id()), std::string(max_label_bytes, 'x'));
}

TEST_P(EachObjectContext, DieWithTheirOwner) {
    GLuint id = 0;
    {
        const Buffer buffer = make_buffer(gl(), "short-lived", 4, nullptr);
        id = buffer.id();
        EXPECT_EQ(gl().IsBuffer(id), GL_TRUE);
    }
    EXPECT_EQ(gl().IsBuffer(id), GL_FALSE);
}

TEST_P(EachObjectContext, MoveWithoutBeingCopied) {
    static_assert(!std::is_copy_constructible_v<Texture> && !std::is_copy_assignable_v<Texture>);
    static_assert(!std::is_copy_constructible_v<Program> && !std::is_copy_assignable_v<Program>);
    Texture first = make_texture_2d(gl(), "first", GL_RGBA8, 1, 1);
    const GLuint first_id = first.id();
    Texture moved(std::move(first));
    EXPECT_FALSE(first);  // NOLINT(bugprone-use-after-move): what a moved object holds is the subject
    EXPECT_EQ(moved.id(), first_id);
    GLuint second_id = 0;
    {
        Texture second = make_texture_2d(gl(), "second", GL_RGBA8, 1, 1);
        second_id = second.id();
        moved = std::move(second);
    }
    EXPECT_EQ(moved.id(), second_id);
    EXPECT_EQ(gl().IsTexture(second_id), GL_TRUE);
    EXPECT_EQ(gl().IsTexture(first_id), GL_FALSE);
    Texture empty;
    EXPECT_FALSE(empty);
    empty = std::move(moved);
    EXPECT_EQ(empty.id(), second_id);
}

TEST_P(EachObjectContext, BuffersHoldTheirData) {
    const std::array<int, 3> data{3, 1, 4};
    const Buffer buffer = make_buffer(gl(), "data", sizeof(data), data.data());
    std::array<int, 3> read{};
    gl().GetNamedBufferSubData(buffer.id(), 0, sizeof(read), read.data());
    EXPECT_EQ(read, data);
}

TEST_P(EachObjectContext, TexturesHaveTheirSizeAndNoSurprisingFilter) {
    const Texture texture = make_texture_2d(gl(), "texture", GL_RGBA16F, 12, 5, 3);
    const auto level = [&](GLint number, GLenum name) {
        GLint value = 0;
        gl().GetTextureLevelParameteriv(texture.id(), number, name, &value);
        return value;
    };
    const auto parameter = [&](GLenum name) {
        GLint value = 0;
        gl().GetTextureParameteriv(texture.id(), name, &value);
        return value;
    };
    EXPECT_EQ(level(0, GL_TEXTURE_WIDTH), 12);
    EXPECT_EQ(level(0, GL_TEXTURE_HEIGHT), 5);
    EXPECT_EQ(level(2, GL_TEXTURE_WIDTH), 3);
    EXPECT_EQ(level(0, GL_TEXTURE_INTERNAL_FORMAT), GL_RGBA16F);
    EXPECT_EQ(parameter(GL_TEXTURE_IMMUTABLE_LEVELS), 3);
    EXPECT_EQ(parameter(GL_TEXTURE_MIN_FILTER), GL_NEAREST);
    EXPECT_EQ(parameter(GL_TEXTURE_MAG_FILTER), GL_NEAREST);
    EXPECT_EQ(parameter(GL_TEXTURE_WRAP_S), GL_CLAMP_TO_EDGE);
}

TEST_P(EachObjectContext, KnowTheirMemory) {
    struct Row {
        GLenum format;
        int bytes;
    };
    for (const Row& row :
         {Row{GL_R8, 1}, Row{GL_R16F, 2}, Row{GL_DEPTH_COMPONENT16, 2}, Row{GL_RGBA8, 4}, Row{GL_R32F, 4},
          Row{GL_R32UI, 4}, Row{GL_DEPTH_COMPONENT24, 4}, Row{GL_DEPTH_COMPONENT32F, 4}, Row{GL_DEPTH24_STENCIL8, 4},
          Row{GL_RGBA16F, 8}, Row{GL_DEPTH32F_STENCIL8, 8}, Row{GL_RGBA32F, 16}}) {
        const Texture texture = make_texture_2d(gl(), "sized", row.format, 7, 5);
        EXPECT_EQ(texture.memory_bytes(), 7 * 5 * row.bytes) << row.format;
    }
    // 7 x 5, 3 x 2, 1 x 1.
    Texture mipmapped = make_texture_2d(gl(), "mipmapped", GL_RGBA8, 7, 5, 3);
    EXPECT_EQ(mipmapped.memory_bytes(), (35 + 6 + 1) * 4);
    EXPECT_EQ(make_texture_2d_multisample(gl(), "samples", GL_RGBA8, 7, 5, 4).memory_bytes(), 35 * 4 * 4);
    const Buffer buffer = make_buffer(gl(), "sized", 12, nullptr);
    EXPECT_EQ(buffer.memory_bytes(), 12);
    EXPECT_EQ(memory_bytes_of(mipmapped, buffer, Texture()), 42 * 4 + 12);
    const Texture moved = std::move(mipmapped);
    EXPECT_EQ(moved.memory_bytes(), 42 * 4);
    EXPECT_EQ(mipmapped.memory_bytes(), 0);
    EXPECT_THROW(make_texture_2d(gl(), "no such format", GL_RGB8, 1, 1), std::logic_error);
}

TEST_P(EachObjectContext, FramebuffersDrawToAllTheirColors) {
    const Texture a = make_texture_2d(gl(), "a", GL_RGBA8, 2, 2);
    const Texture b = make_texture_2d(gl(), "b", GL_R32F, 2, 2);
    const Texture depth = make_texture_2d(gl(), "depth", GL_DEPTH_COMPONENT32F, 2, 2);
    const std::array colors{a.id(), b.id()};
    const Framebuffer framebuffer = make_framebuffer(gl(), "two colors", colors, depth.id());
    const std::array<GLfloat, 4> value{0.25F, 0, 0, 0};
    gl().ClearNamedFramebufferfv(framebuffer.id(), GL_COLOR, 1, value.data());
    const GLfloat near = 0.5F;
    gl().ClearNamedFramebufferfv(framebuffer.id(), GL_DEPTH, 0, &near);
    std::array<GLfloat, 4> read{};
    gl().GetTextureImage(b.id(), 0, GL_RED, GL_FLOAT, sizeof(read), read.data());
    EXPECT_THAT(read, testing::Each(0.25F));
    gl().GetTextureImage(depth.id(), 0, GL_DEPTH_COMPONENT, GL_FLOAT, sizeof(read), read.data());
    EXPECT_THAT(read, testing::Each(0.5F));
}

TEST_P(EachObjectContext, DepthAloneIsComplete) {
    const Texture depth = make_texture_2d(gl(), "depth", GL_DEPTH_COMPONENT32F, 2, 2);
    EXPECT_TRUE(make_framebuffer(gl(), "depth only", {}, depth.id()));
}

TEST_P(EachObjectContext, StencilBitsAreAttachedWithTheirDepth) {
    const auto attached = [&](GLenum format, GLenum attachment) {
        const Texture texture = make_texture_2d(gl(), "depth", format, 2, 2);
        const Framebuffer framebuffer = make_framebuffer(gl(), "depth", {}, texture.id());
        GLint type = GL_NONE;
        gl().GetNamedFramebufferAttachmentParameteriv(framebuffer.id(), attachment,
                                                      GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE, &type);
        return type == GL_TEXTURE;
    };
    EXPECT_TRUE(attached(GL_DEPTH24_STENCIL8, GL_STENCIL_ATTACHMENT));
    EXPECT_TRUE(attached(GL_DEPTH24_STENCIL8, GL_DEPTH_ATTACHMENT));
    EXPECT_TRUE(attached(GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT));
    EXPECT_FALSE(attached(GL_DEPTH_COMPONENT32F, GL_STENCIL_ATTACHMENT));
}

TEST_P(EachObjectContext, AnIncompleteFramebufferIsNamed) {
    EXPECT_EQ(message_of<RenderError>([&] { make_framebuffer(gl(), "nothing", {}, 0); }),
              "framebuffer 'nothing' is not complete: it has no attachment");
    // Shared exponents can be sampled but not rendered to.
    const Texture shared_exponent = make_texture_2d(gl(), "shared exponent", GL_RGB9_E5, 2, 2);
    const std::array colors{shared_exponent.id()};
    EXPECT_THAT(message_of<RenderError>([&] { make_framebuffer(gl(), "unrenderable", colors, 0); }),
                HasSubstr("framebuffer 'unrenderable' is not complete"));
}

TEST_P(EachObjectContext, ABrokenShaderNamesItsStage) {
    constexpr std::string_view broken = "#version 450\nvoid main() { gl_Position = vec4(no_such_name); }\n";
    const auto build = [&](std::string_view vertex, std::string_view fragment) {
        return message_of<RenderError>([&] { Program(gl(), "leaves", vertex, fragment); });
    };
    EXPECT_THAT(build(broken, white_fragment_shader),
                AllOf(HasSubstr("program 'leaves': the vertex shader"), HasSubstr("no_such_name")));
    EXPECT_THAT(build(full_screen_vertex_shader, "#version 450\nvoid main() { no_such_name = 1; }\n"),
                AllOf(HasSubstr("program 'leaves': the fragment shader"), HasSubstr("no_such_name")));
    EXPECT_THAT(build(full_screen_vertex_shader, ""), HasSubstr("program 'leaves'"));
    EXPECT_THAT(build(full_screen_vertex_shader,
                      "#version 450\nfloat missing_part();\nout vec4 color;\n"
                      "void main() { color = vec4(missing_part()); }\n"),
                AllOf(HasSubstr("program 'leaves': the stages do not link"), HasSubstr("missing_part")));
    // The exception has reported it: the next check must not throw the compiler's message again.
    context().check("after the broken shaders");
}

TEST_P(EachObjectContext, UniformsReachTheShader) {
    constexpr std::string_view fragment = R"(#version 450
layout(std430, binding = 3) buffer Seen { float seen[28]; };
uniform int i; uniform uint u; uniform float f; uniform vec2 v2; uniform vec3 v3; uniform vec4 v4; uniform mat4 m;
layout(location = 0) out vec4 color;  // no blending
void main() {
    seen[0] = float(i); seen[1] = float(u); seen[2] = f;
    for (int k = 0; k < 2; ++k) seen[3 + k] = v2[k];
    for (int k = 0; k < 3; ++k) seen[5 + k] = v3[k];
    for (int k = 0; k < 4; ++k) seen[8 + k] = v4[k];
    for (int k = 0; k < 16; ++k) seen[12 + k] = m[k / 4][k % 4];
    color = vec4(1.0);
}
)";
    const Program program(gl(), "uniforms", full_screen_vertex_shader, fragment);
    glm::mat4 matrix;
    for (int k = 0; k < 16; ++k) glm::value_ptr(matrix)[k] = static_cast<float>(12 + k);
    program.set("i", -1);
    program.set("u", 3000000000U);
    program.set("f", 2.5F);
    program.set("v2", glm::vec2(3, 4));
    program.set("v3", glm::vec3(5, 6, 7));
    program.set("v4", glm::vec4(8, 9, 10, 11));
    program.set("m", matrix);
    program.set("no_such_uniform", 1.0F);

    const std::array<float, 28> zeros{};
    const Buffer seen = make_buffer(gl(), "seen", sizeof(zeros), zeros.data());
    const Target target(gl(), 1);
    const VertexArray vertices = make_vertex_array(gl(), "none");
    gl().BindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, seen.id());
    gl().BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.id());
    gl().BindVertexArray(vertices.id());
    gl().Viewport(0, 0, 1, 1);
    program.use();
    gl().DrawArrays(GL_TRIANGLES, 0, 3);
    gl().MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    std::array<float, 28> read{};
    gl().GetNamedBufferSubData(seen.id(), 0, sizeof(read), read.data());
    std::array<float, 28> expected{-1.0F, 3e9F, 2.5F};
    for (std::size_t k = 3; k < expected.size(); ++k) expected[k] = static_cast<float>(k);
    EXPECT_EQ(read, expected);
    EXPECT_EQ(target.read(0, 0), (Pixel{255, 255, 255, 255}));
}

/// A value of every type of uniform, none of them 0, as floats in the order of their components.
constexpr std::string_view every_uniform = R"(#version 450
uniform float u_float; uniform vec2 u_vec2; uniform vec3 u_vec3; uniform vec4 u_vec4;
uniform double u_double; uniform dvec2 u_dvec2; uniform dvec3 u_dvec3; uniform dvec4 u_dvec4;
uniform int u_int; uniform ivec2 u_ivec2; uniform ivec3 u_ivec3; uniform ivec4 u_ivec4;
uniform uint u_uint; uniform uvec2 u_uvec2; uniform uvec3 u_uvec3; uniform uvec4 u_uvec4;
uniform bool u_bool; uniform bvec2 u_bvec2; uniform bvec3 u_bvec3; uniform bvec4 u_bvec4;
uniform mat2 u_mat2; uniform mat3 u_mat3; uniform mat4 u_mat4;
uniform mat2x3 u_mat2x3; uniform mat2x4 u_mat2x4; uniform mat3x2 u_mat3x2;
uniform mat3x4 u_mat3x4; uniform mat4x2 u_mat4x2; uniform mat4x3 u_mat4x3;
uniform dmat2 u_dmat2; uniform dmat3 u_dmat3; uniform dmat4 u_dmat4;
uniform dmat2x3 u_dmat2x3; uniform dmat2x4 u_dmat2x4; uniform dmat3x2 u_dmat3x2;
uniform dmat3x4 u_dmat3x4; uniform dmat4x2 u_dmat4x2; uniform dmat4x3 u_dmat4x3;
uniform float u_floats[3]; uniform ivec2 u_ivecs[2];
struct Inner { float a; uvec3 b[2]; };
uniform Inner u_inner[2];
uniform sampler2D u_sampler; uniform usampler2DArray u_usampler;
layout(r32ui) uniform uimage2D u_image;
layout(location = 0) out vec4 color;  // no blending
void main() {
    double sum = u_float + u_vec2.y + u_vec3.z + u_vec4.w + u_double + u_dvec2.y + u_dvec3.z + u_dvec4.w;
    sum += u_int + u_ivec2.y + u_ivec3.z + u_ivec4.w + u_uint + u_uvec2.y + u_uvec3.z + u_uvec4.w;
    sum += int(u_bool) + int(u_bvec2.y) + int(u_bvec3.z) + int(u_bvec4.w);
    sum += u_mat2[1][1] + u_mat3[2][2] + u_mat4[3][3] + u_mat2x3[1][2] + u_mat2x4[1][3] + u_mat3x2[2][1];
    sum += u_mat3x4[2][3] + u_mat4x2[3][1] + u_mat4x3[3][2];
    sum += u_dmat2[1][1] + u_dmat3[2][2] + u_dmat4[3][3] + u_dmat2x3[1][2] + u_dmat2x4[1][3] + u_dmat3x2[2][1];
    sum += u_dmat3x4[2][3] + u_dmat4x2[3][1] + u_dmat4x3[3][2];
    for (int i = 0; i < 3; ++i) sum += u_floats[i];
    for (int i = 0; i < 2; ++i) sum += u_ivecs[i].y + u_inner[i].a + u_inner[i].b[0].z + u_inner[i].b[1].z;
    sum += texelFetch(u_sampler, ivec2(0), 0).r + texelFetch(u_usampler, ivec3(0), 0).r;
    sum += imageLoad(u_image, ivec2(0)).r;
    color = vec4(float(sum));
}
)";

/// An active uniform's elements by name, as GL itself lists them.
std::vector<std::pair<std::string, GLenum>> uniforms_of(const Functions& gl, const Program& program) {
    std::vector<std::pair<std::string, GLenum>> all;
    GLint count = 0;
    gl.GetProgramiv(program.id(), GL_ACTIVE_UNIFORMS, &count);
    for (GLint i = 0; i < count; ++i) {
        std::array<GLchar, 64> text{};
        GLint size = 0;
        GLenum type = 0;
        gl.GetActiveUniform(program.id(), static_cast<GLuint>(i), 64, nullptr, &size, &type, text.data());
        std::string name = text.data();
        if (size == 1) {
            all.emplace_back(name, type);
        } else {
            name.erase(name.size() - 3);
            for (int at = 0; at < size; ++at) all.emplace_back(name + "[" + std::to_string(at) + "]", type);
        }
    }
    return all;
}

std::array<GLdouble, 16> value_of(const Functions& gl, const Program& program, const std::string& name) {
    std::array<GLdouble, 16> value{};
    gl.GetUniformdv(program.id(), gl.GetUniformLocation(program.id(), name.c_str()), value.data());
    return value;
}

/// Sets it to 1, 2, 3, ...
void set_ascending(const Functions& gl, const Program& program, const std::string& name, GLenum type) {
    const GLint at = gl.GetUniformLocation(program.id(), name.c_str());
    const GLuint id = program.id();
    const std::array<GLfloat, 16> f{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};
    std::array<GLdouble, 16> d{};
    std::ranges::copy(f, d.begin());
    const std::array<GLint, 4> i{1, 2, 3, 4};
    const std::array<GLuint, 4> u{1, 2, 3, 4};
    const std::map<GLenum, std::function<void()>> calls = {
        {GL_FLOAT, [&] { gl.ProgramUniform1fv(id, at, 1, f.data()); }},
        {GL_FLOAT_VEC2, [&] { gl.ProgramUniform2fv(id, at, 1, f.data()); }},
        {GL_FLOAT_VEC3, [&] { gl.ProgramUniform3fv(id, at, 1, f.data()); }},
        {GL_FLOAT_VEC4, [&] { gl.ProgramUniform4fv(id, at, 1, f.data()); }},
        {GL_DOUBLE, [&] { gl.ProgramUniform1dv(id, at, 1, d.data()); }},
        {GL_DOUBLE_VEC2, [&] { gl.ProgramUniform2dv(id, at, 1, d.data()); }},
        {GL_DOUBLE_VEC3, [&] { gl.ProgramUniform3dv(id, at, 1, d.data()); }},
        {GL_DOUBLE_VEC4, [&] { gl.ProgramUniform4dv(id, at, 1, d.data()); }},
        {GL_INT, [&] { gl.ProgramUniform1iv(id, at, 1, i.data()); }},
        {GL_INT_VEC2, [&] { gl.ProgramUniform2iv(id, at, 1, i.data()); }},
        {GL_INT_VEC3, [&] { gl.ProgramUniform3iv(id, at, 1, i.data()); }},
        {GL_INT_VEC4, [&] { gl.ProgramUniform4iv(id, at, 1, i.data()); }},
        {GL_UNSIGNED_INT, [&] { gl.ProgramUniform1uiv(id, at, 1, u.data()); }},
        {GL_UNSIGNED_INT_VEC2, [&] { gl.ProgramUniform2uiv(id, at, 1, u.data()); }},
        {GL_UNSIGNED_INT_VEC3, [&] { gl.ProgramUniform3uiv(id, at, 1, u.data()); }},
        {GL_UNSIGNED_INT_VEC4, [&] { gl.ProgramUniform4uiv(id, at, 1, u.data()); }},
        {GL_FLOAT_MAT2, [&] { gl.ProgramUniformMatrix2fv(id, at, 1, GL_FALSE, f.data()); }},
        {GL_FLOAT_MAT3, [&] { gl.ProgramUniformMatrix3fv(id, at, 1, GL_FALSE, f.data()); }},
        {GL_FLOAT_MAT4, [&] { gl.ProgramUniformMatrix4fv(id, at, 1, GL_FALSE, f.data()); }},
        {GL_FLOAT_MAT2x3, [&] { gl.ProgramUniformMatrix2x3fv(id, at, 1, GL_FALSE, f.data()); }},
        {GL_FLOAT_MAT2x4, [&] { gl.ProgramUniformMatrix2x4fv(id, at, 1, GL_FALSE, f.data()); }},
        {GL_FLOAT_MAT3x2, [&] { gl.ProgramUniformMatrix3x2fv(id, at, 1, GL_FALSE, f.data()); }},
        {GL_FLOAT_MAT3x4, [&] { gl.ProgramUniformMatrix3x4fv(id, at, 1, GL_FALSE, f.data()); }},
        {GL_FLOAT_MAT4x2, [&] { gl.ProgramUniformMatrix4x2fv(id, at, 1, GL_FALSE, f.data()); }},
        {GL_FLOAT_MAT4x3, [&] { gl.ProgramUniformMatrix4x3fv(id, at, 1, GL_FALSE, f.data()); }},
        {GL_DOUBLE_MAT2, [&] { gl.ProgramUniformMatrix2dv(id, at, 1, GL_FALSE, d.data()); }},
        {GL_DOUBLE_MAT3, [&] { gl.ProgramUniformMatrix3dv(id, at, 1, GL_FALSE, d.data()); }},
        {GL_DOUBLE_MAT4, [&] { gl.ProgramUniformMatrix4dv(id, at, 1, GL_FALSE, d.data()); }},
        {GL_DOUBLE_MAT2x3, [&] { gl.ProgramUniformMatrix2x3dv(id, at, 1, GL_FALSE, d.data()); }},
        {GL_DOUBLE_MAT2x4, [&] { gl.ProgramUniformMatrix2x4dv(id, at, 1, GL_FALSE, d.data()); }},
        {GL_DOUBLE_MAT3x2, [&] { gl.ProgramUniformMatrix3x2dv(id, at, 1, GL_FALSE, d.data()); }},
        {GL_DOUBLE_MAT3x4, [&] { gl.ProgramUniformMatrix3x4dv(id, at, 1, GL_FALSE, d.data()); }},
        {GL_DOUBLE_MAT4x2, [&] { gl.ProgramUniformMatrix4x2dv(id, at, 1, GL_FALSE, d.data()); }},
        {GL_DOUBLE_MAT4x3, [&] { gl.ProgramUniformMatrix4x3dv(id, at, 1, GL_FALSE, d.data()); }},
        {GL_BOOL, [&] { gl.ProgramUniform1iv(id, at, 1, i.data()); }},
        {GL_BOOL_VEC2, [&] { gl.ProgramUniform2iv(id, at, 1, i.data()); }},
        {GL_BOOL_VEC3, [&] { gl.ProgramUniform3iv(id, at, 1, i.data()); }},
        {GL_BOOL_VEC4, [&] { gl.ProgramUniform4iv(id, at, 1, i.data()); }},
        {GL_SAMPLER_2D, [&] { gl.ProgramUniform1iv(id, at, 1, i.data()); }},
        {GL_UNSIGNED_INT_SAMPLER_2D_ARRAY, [&] { gl.ProgramUniform1iv(id, at, 1, i.data()); }},
        {GL_UNSIGNED_INT_IMAGE_2D, [&] { gl.ProgramUniform1iv(id, at, 1, i.data()); }},
    };
    calls.at(type)();
}

TEST_P(EachObjectContext, CopiesUniformsOfEveryType) {
    const Program from(gl(), "from", full_screen_vertex_shader, every_uniform);
    const Program to(gl(), "to", full_screen_vertex_shader, every_uniform);
    const auto uniforms = uniforms_of(gl(), from);
    EXPECT_EQ(uniforms.size(), 38u + 3 + 2 + 2 * 3 + 3);
    for (const auto& [name, type] : uniforms) set_ascending(gl(), from, name, type);
    to.copy_uniforms(from);
    for (const auto& [name, type] : uniforms) {
        EXPECT_NE(value_of(gl(), from, name)[0], 0) << name;
        EXPECT_EQ(value_of(gl(), to, name), value_of(gl(), from, name)) << name;
    }
}

TEST_P(EachObjectContext, RefusesToCopyAnUnknownTypeByItsName) {
    EXPECT_THAT(message_of<std::logic_error>([&] {
                    copy_uniform(gl(), {0, 0}, {0, 0}, "u_strange", 0xBEEF);
                }),
                AllOf(HasSubstr("u_strange"), HasSubstr("0xbeef")));
}

TEST_P(EachObjectContext, ProgramsGiveTexturesUnitsOfTheirOwn) {
    constexpr std::string_view two_textures = R"(#version 450
layout(binding = 0) uniform sampler2D u_fixed;
uniform sampler2D u_first;
uniform sampler2D u_second;
layout(location = 0) out vec4 color;  // no blending
void main() {
    color = vec4(texelFetch(u_first, ivec2(0), 0).r, texelFetch(u_second, ivec2(0), 0).r,
                 texelFetch(u_fixed, ivec2(0), 0).r, 1.0);
}
)";
    const auto filled = [&](GLubyte value) {
        Texture texture = make_texture_2d(gl(), "filled", GL_R8, 1, 1);
        gl().TextureSubImage2D(texture.id(), 0, 0, 0, 1, 1, GL_RED, GL_UNSIGNED_BYTE, &value);
        return texture;
    };
    const Texture first = filled(10), second = filled(20), fixed = filled(30);
    const Target target(gl(), 1);
    const VertexArray vertices = make_vertex_array(gl(), "none");
    const auto draw = [&](const Program& program) {
        gl().BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.id());
        gl().Viewport(0, 0, 1, 1);
        gl().BindVertexArray(vertices.id());
        program.use();
        gl().DrawArrays(GL_TRIANGLES, 0, 3);
        return target.read(0, 0);
    };
    const Program program(gl(), "two textures", full_screen_vertex_shader, two_textures);
    gl().BindTextureUnit(0, fixed.id());
    program.set_texture("u_first", first);
    program.set_texture("u_second", second);
    program.set_texture("u_no_such", second);
    EXPECT_EQ(draw(program), (Pixel{10, 20, 30, 255}));
    // The same units again, whatever comes first.
    program.set_texture("u_second", first);
    program.set_texture("u_first", second);
    EXPECT_EQ(draw(program), (Pixel{20, 10, 30, 255}));
    // A rewritten program finds them where the original had them bound.
    const Program rewritten = program.with_fragment_source("rewritten", std::string(two_textures) + "\n");
    rewritten.copy_uniforms(program);
    EXPECT_EQ(draw(rewritten), (Pixel{20, 10, 30, 255}));
    rewritten.set_texture("u_second", second);
    EXPECT_EQ(draw(rewritten), (Pixel{20, 20, 30, 255}));
}

/// Counts objects that were made and not yet deleted, through functions that replace the context's. One at a time.
class LivingObjects {
  public:
    explicit LivingObjects(const Functions& real) : m_functions(real) {
        s_real = &real;
        s_shaders = s_programs = 0;
        m_functions.CreateShader = [](GLenum stage) { return ++s_shaders, s_real->CreateShader(stage); };
        m_functions.DeleteShader = [](GLuint id) { --s_shaders, s_real->DeleteShader(id); };
        m_functions.CreateProgram = [] { return ++s_programs, s_real->CreateProgram(); };
        m_functions.DeleteProgram = [](GLuint id) { --s_programs, s_real->DeleteProgram(id); };
    }
    const Functions& functions() const { return m_functions; }
    int shaders() const { return s_shaders; }
    int programs() const { return s_programs; }

  private:
    static inline const Functions* s_real = nullptr;
    static inline int s_shaders = 0, s_programs = 0;
    Functions m_functions;
};

TEST_P(EachObjectContext, AProgramThatDoesNotBuildLeavesNothing) {
    const LivingObjects living(gl());
    const auto build = [&](std::string_view fragment) {
        Program(living.functions(), "never", full_screen_vertex_shader, fragment);
    };
    EXPECT_THROW(build("#version 450\nvoid main() { no_such_name = 1; }\n"), RenderError);
    EXPECT_THROW(build("#version 450\nin vec2 v_no_such;\nout vec4 color;\nvoid main() { color = v_no_such.xyxy; }\n"),
                 RenderError);
    EXPECT_EQ(living.shaders(), 0);
    EXPECT_EQ(living.programs(), 0);
    build(white_fragment_shader);
    EXPECT_EQ(living.shaders(), 0);
    EXPECT_EQ(living.programs(), 0);
}

TEST(ShaderFile, GivesTheFilesOfTheRepository) {
    for (const EmbeddedFile& file : embedded_shaders()) {
        std::ifstream stream(source_folder() + std::string("/shaders/") + std::string(file.path), std::ios::binary);
        const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
        const std::string text = shader_file(file.path);
        const bool has_version = bytes.starts_with("#version");
        const std::size_t end = has_version ? bytes.find('\n') + 1 : 0;
        EXPECT_EQ(text.substr(0, end), bytes.substr(0, end)) << file.path;
        EXPECT_EQ(text.substr(end, 6), "#line ") << file.path;
        EXPECT_EQ(text.substr(text.find('\n', end) + 1), bytes.substr(end)) << file.path;
    }
    EXPECT_FALSE(embedded_shaders().empty());
}

TEST_P(EachObjectContext, AShaderErrorNamesTheFileAndItsOwnLine) {
    const std::string file = shader_file("common/composite.glsl");
    const auto lines = std::ranges::count(file, '\n') - 1;  // without the #line
    const std::string source = "#version 450 core\n#define SHEER_ONE 1\n" + file + "no such word;\n";
    const std::string message =
        message_of<RenderError>([&] { Program(gl(), "broken", full_screen_vertex_shader, source); });
    EXPECT_THAT(message, HasSubstr("shaders/common/composite.glsl:" + std::to_string(lines + 1) + "("));
}

TEST(ShaderFile, NamesAMissingFile) {
    EXPECT_THAT(message_of<std::out_of_range>([] { shader_file("methods/no_such.glsl"); }),
                HasSubstr("'methods/no_such.glsl'"));
}

}  // namespace
}  // namespace sheer::gl::objects_test
