#include "renderer/counting/early_tests.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>
#include <optional>

#include "renderer/passes/pass.h"

namespace sheer {

namespace {

constexpr int stand_in_size_px = 64;
constexpr int frames_each = 5;
constexpr int least_iterations = 64, most_iterations = 1 << 18;
/// A frame with the loop must take this many times as long as one without it.
constexpr double clear_ratio = 10;
constexpr int most_tries = 4;

/// Which of the tests fails.
enum class Fails { nothing, depth, stencil };

std::string stand_in_source(const DrawKind& kind) {
    std::string source = glsl_version, cut;
    if (kind.fetches_framebuffer)
        source +=
            "#extension GL_EXT_shader_framebuffer_fetch : require\n"
            "layout(location = 0) inout vec4 o_color;\n"
            "float start() { return o_color.r; }\n";
    else
        source +=
            "layout(location = 0) out vec4 o_color;\n"
            "float start() { return 0.0; }\n";
    if (kind.discards) cut += "if (sum > 1e30) discard;";
    if (kind.writes_sample_mask) cut += "gl_SampleMask[0] = sum > 1e30 ? 0 : ~0;";
    return source + "void cut(float sum) {" + cut + "}\n" + std::string(gl::shader_file("common/early_tests.glsl"));
}

/// A small picture of its own, with depth and stencil, and the stand-in that is drawn into it.
class StandIn {
  public:
    StandIn(const gl::Functions& gl, const DrawKind& kind)
        : m_gl(gl),
          m_kind(kind),
          m_color(texture("early tests: color", GL_RGBA8)),
          m_depth(texture("early tests: depth", GL_DEPTH32F_STENCIL8)),
          m_framebuffer(gl::make_framebuffer(gl, "early tests", std::array{m_color.id()}, m_depth.id())),
          m_program(gl, "early tests", gl::shader_file("common/fullscreen.vert.glsl"), stand_in_source(kind)),
          m_vertex_array(gl::make_vertex_array(gl, "early tests")) {}

    /// The shortest of some frames, in milliseconds.
    double shortest_ms(Fails fails, int iterations) const {
        using Clock = std::chrono::steady_clock;
        m_program.set("u_iterations", iterations);
        double shortest = std::numeric_limits<double>::infinity();
        for (int frame = 0; frame < frames_each; ++frame) {
            const Pass drawing = begin(fails);
            m_gl.Finish();
            const auto begin = Clock::now();
            m_gl.DrawArrays(GL_TRIANGLES, 0, 3);
            m_gl.Finish();
            shortest = std::min(shortest, std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
        }
        return shortest;
    }

  private:
    gl::Texture texture(std::string_view label, GLenum format) const {
        if (m_kind.samples <= 1) return gl::make_texture_2d(m_gl, label, format, stand_in_size_px, stand_in_size_px);
        return gl::make_texture_2d_multisample(m_gl, label, format, stand_in_size_px, stand_in_size_px, m_kind.samples);
    }

    /// The triangle lies at depth 0.
    Pass begin(Fails fails) const {
        Pass drawing(m_gl, m_framebuffer, stand_in_size_px, stand_in_size_px);
        drawing.clear_color(glm::vec4(0));
        drawing.clear_depth(fails == Fails::depth ? 0.0f : 1.0f);
        drawing.clear_stencil(fails == Fails::stencil ? 1 : 0);
        if (m_kind.tests_depth) drawing.depth_test(GL_LESS);
        drawing.depth_write(m_kind.writes_depth);
        if (m_kind.tests_stencil)
            drawing.stencil(GL_EQUAL, 0, static_cast<GLenum>(m_kind.stencil_fails),
                            static_cast<GLenum>(m_kind.depth_fails), static_cast<GLenum>(m_kind.depth_passes));
        drawing.stencil_mask(m_kind.has_stencil_mask ? 0xff : 0);
        if (m_kind.covers_by_alpha) drawing.alpha_to_coverage();
        m_program.use();
        m_gl.BindVertexArray(m_vertex_array.id());
        return drawing;
    }

    const gl::Functions& m_gl;
    const DrawKind& m_kind;
    gl::Texture m_color, m_depth;
    gl::Framebuffer m_framebuffer;
    gl::Program m_program;
    gl::VertexArray m_vertex_array;
};

/// The iterations of a loop that is long enough to measure; none if no loop is.
std::optional<int> long_enough(const StandIn& stand_in) {
    for (int iterations = least_iterations; iterations <= most_iterations; iterations *= 4)
        if (stand_in.shortest_ms(Fails::nothing, iterations) > clear_ratio * stand_in.shortest_ms(Fails::nothing, 0))
            return iterations;
    return std::nullopt;
}

TestTime time_of(const StandIn& stand_in, Fails test, int iterations) {
    for (int tries = 0; tries < most_tries; ++tries) {
        const double passing_ms = stand_in.shortest_ms(Fails::nothing, iterations);
        const double failing_ms = stand_in.shortest_ms(test, iterations);
        if (failing_ms < passing_ms / 3) return TestTime::early;
        if (failing_ms > passing_ms * 2 / 3) return TestTime::late;
    }
    return TestTime::unclear;
}

TestTime probe(const gl::Functions& gl, const DrawKind& kind) {
    const StandIn stand_in(gl, kind);
    const std::optional<int> iterations = long_enough(stand_in);
    if (!iterations) return TestTime::unclear;
    if (!kind.tests_stencil) return time_of(stand_in, Fails::depth, *iterations);
    const TestTime of_stencil = time_of(stand_in, Fails::stencil, *iterations);
    if (!kind.tests_depth) return of_stencil;
    return time_of(stand_in, Fails::depth, *iterations) == of_stencil ? of_stencil : TestTime::unclear;
}

}  // namespace

bool DrawKind::writes_stencil() const {
    return tests_stencil && has_stencil_mask &&
           (stencil_fails != GL_KEEP || depth_fails != GL_KEEP || depth_passes != GL_KEEP);
}

TestTime EarlyTests::ask(const DrawKind& kind) {
    const auto known = m_known.find(kind);
    if (known != m_known.end()) return known->second;
    const TestTime answer = probe(m_context.gl(), kind);
    m_context.check("asking when fragments are tested");
    return m_known.emplace(kind, answer).first->second;
}

}  // namespace sheer
