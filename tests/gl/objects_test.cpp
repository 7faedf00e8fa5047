#include "renderer/gl/objects.h"

#include <embedded_shaders.h>

#include <fstream>
#include <glm/gtc/type_ptr.hpp>
#include <iterator>
#include <stdexcept>

#include "tests/gl/gl_test.h"

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

TEST_P(EachObjectContext, FramebuffersDrawToAllTheirColors) {
    const Texture a = make_texture_2d(gl(), "a", GL_RGBA8, 2, 2);
    const Texture b = make_texture_2d(gl(), "b", GL_R32F, 2, 2);
    const Texture depth = make_texture_2d(gl(), "depth", GL_DEPTH_COMPONENT32F, 2, 2);
    const std::array colors{a.id(), b.id()};
    const Framebuffer framebuffer = make_framebuffer(gl(), "two colours", colors, depth.id());
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
    // The exception has said it: the compiler's message must not be thrown again at whoever checks next.
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

TEST(ShaderFile, GivesTheFilesOfTheRepository) {
    for (const EmbeddedFile& file : embedded_shaders()) {
        std::ifstream stream(std::string(SHEER_SOURCE_DIR "/shaders/") + std::string(file.path), std::ios::binary);
        const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
        EXPECT_EQ(shader_file(file.path), bytes) << file.path;
    }
    EXPECT_FALSE(embedded_shaders().empty());
}

TEST(ShaderFile, NamesAMissingFile) {
    EXPECT_THAT(message_of<std::out_of_range>([] { shader_file("methods/no_such.glsl"); }),
                HasSubstr("'methods/no_such.glsl'"));
}

}  // namespace
}  // namespace sheer::gl::objects_test
