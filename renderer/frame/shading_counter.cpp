#include "renderer/frame/shading_counter.h"

#include <array>
#include <regex>
#include <string_view>

namespace sheer {

namespace {

/// Drawing primitive by primitive costs two draws and their state for each.
constexpr std::size_t most_single_draws = 100000;

std::string without_comments(const std::string& source) {
    static const std::regex comment("//[^\n]*");
    return std::regex_replace(source, comment, "");
}

bool writes_depth_itself(const gl::Functions& gl, const gl::Program& program) {
    return gl.GetProgramResourceIndex(program.id(), GL_PROGRAM_OUTPUT, "gl_FragDepth") != GL_INVALID_INDEX;
}

bool query_runs(const gl::Functions& gl) {
    for (const GLenum target : {GL_SAMPLES_PASSED, GL_ANY_SAMPLES_PASSED, GL_ANY_SAMPLES_PASSED_CONSERVATIVE}) {
        GLint query = 0;
        gl.GetQueryiv(target, GL_CURRENT_QUERY, &query);
        if (query != 0) return true;
    }
    return false;
}

bool writes_depth(const gl::Functions& gl) {
    GLboolean mask = GL_FALSE;
    gl.GetBooleanv(GL_DEPTH_WRITEMASK, &mask);
    return gl.IsEnabled(GL_DEPTH_TEST) == GL_TRUE && mask == GL_TRUE;
}

bool writes_stencil(const gl::Functions& gl) {
    if (gl.IsEnabled(GL_STENCIL_TEST) == GL_FALSE) return false;
    for (const GLenum operation : {GL_STENCIL_FAIL, GL_STENCIL_PASS_DEPTH_FAIL, GL_STENCIL_PASS_DEPTH_PASS}) {
        GLint value = 0;
        gl.GetIntegerv(operation, &value);
        if (value != GL_KEEP) return true;
    }
    return false;
}

/// Nothing is written while it lives.
class NothingWritten {
  public:
    explicit NothingWritten(const gl::Functions& gl) : m_gl(gl) {
        gl.GetBooleanv(GL_DEPTH_WRITEMASK, &m_depth);
        gl.GetBooleani_v(GL_COLOR_WRITEMASK, 0, m_color.data());
        gl.GetIntegerv(GL_STENCIL_WRITEMASK, &m_stencil);
        gl.DepthMask(GL_FALSE);
        gl.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
        gl.StencilMask(0);
    }
    ~NothingWritten() {
        m_gl.DepthMask(m_depth);
        m_gl.ColorMask(m_color[0], m_color[1], m_color[2], m_color[3]);
        m_gl.StencilMask(static_cast<GLuint>(m_stencil));
    }
    NothingWritten(const NothingWritten&) = delete;
    NothingWritten& operator=(const NothingWritten&) = delete;

  private:
    const gl::Functions& m_gl;
    GLboolean m_depth = GL_TRUE;
    std::array<GLboolean, 4> m_color{};
    GLint m_stencil = 0;
};

/// Pixels of the picture for each that is drawn.
glm::vec2 scale_to(const gl::Functions& gl, const CountImage& image) {
    std::array<GLint, 4> viewport{};
    gl.GetIntegerv(GL_VIEWPORT, viewport.data());
    return {static_cast<float>(image.width_px()) / static_cast<float>(viewport[2]),
            static_cast<float>(image.height_px()) / static_cast<float>(viewport[3])};
}

}  // namespace

ShadingCounter::ShadingCounter(const gl::Functions& gl, Scene& scene, const Target& target)
    : m_gl(gl), m_scene(scene), m_image(gl, "shaded fragments", target.width_px(), target.height_px()) {
    m_scene.observe(this);
}

ShadingCounter::~ShadingCounter() {
    m_scene.observe(nullptr);
}

ShadingCounter::Count ShadingCounter::read() const {
    if (!m_reason.empty()) return {std::nullopt, m_reason};
    return {m_image.read(), ""};
}

ShadingCounter::Variant& ShadingCounter::variant_of(const gl::Program& program) {
    const auto known = m_variants.find(program.id());
    if (known != m_variants.end()) return known->second;
    const std::string source = without_comments(program.fragment_source());
    const bool tests_late = writes_depth_itself(m_gl, program);
    const bool may_discard = source.find("discard") != std::string::npos;
    const bool tests_early = source.find("early_fragment_tests") != std::string::npos;
    const std::string layout = tests_late ? "" : " layout(early_fragment_tests) in;";
    const std::string counting = glsl_version + ("#define COUNT_SHADED" + layout + "\n") +
                                 program.fragment_source().substr(std::string_view(glsl_version).size());
    Variant variant{program.with_fragment_source("shaded fragments", counting),
                    tests_late || tests_early || !may_discard};
    return m_variants.emplace(program.id(), std::move(variant)).first->second;
}

void ShadingCounter::prepare(const gl::Program& original, const gl::Program& variant) const {
    variant.copy_uniforms(original);
    variant.set("u_shaded_scale", scale_to(m_gl, m_image));
    m_image.bind();
}

void ShadingCounter::draw_transparent(const gl::Program& program, Order order, std::size_t first, std::size_t count) {
    const Variant& variant = variant_of(program);
    const bool covers_by_alpha = m_gl.IsEnabled(GL_SAMPLE_ALPHA_TO_COVERAGE) == GL_TRUE;
    const bool early_tests_differ =
        (!variant.tests_as_before || covers_by_alpha) && (writes_depth(m_gl) || writes_stencil(m_gl));
    if (!variant.tests_as_before && query_runs(m_gl))
        m_reason = "the method asks how many samples pass, which counting would disturb";
    if (early_tests_differ && count > most_single_draws)
        m_reason = "counting would draw each of " + std::to_string(count) + " primitives by itself; the limit is " +
                   std::to_string(most_single_draws);
    if (!m_reason.empty()) {
        m_scene.draw_unobserved(program, order, first, count);
        return;
    }
    prepare(program, variant.program);
    if (early_tests_differ) {
        draw_twice(program, variant.program, order, first, count);
    } else {
        m_scene.draw_unobserved(variant.program, order, first, count);
    }
}

void ShadingCounter::draw_twice(const gl::Program& program, const gl::Program& variant, Order order, std::size_t first,
                                std::size_t count) const {
    for (std::size_t i = first; i < first + count; ++i) {
        {
            const NothingWritten nothing(m_gl);
            m_scene.draw_unobserved(variant, order, i, 1);
        }
        m_scene.draw_unobserved(program, order, i, 1);
    }
}

}  // namespace sheer
