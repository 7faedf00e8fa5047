#include "renderer/passes/pixel_trace.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sheer {

namespace {

/// Restricts what a method draws to one pixel, and restores the method's scissor.
class OnePixel {
  public:
    OnePixel(const gl::Functions& gl, glm::ivec2 pixel)
        : m_gl(gl), m_had_scissor(gl.IsEnabled(GL_SCISSOR_TEST) == GL_TRUE) {
        gl.GetIntegerv(GL_SCISSOR_BOX, m_box.data());
        m_is_inside = !m_had_scissor || (pixel.x >= m_box[0] && pixel.x < m_box[0] + m_box[2] && pixel.y >= m_box[1] &&
                                         pixel.y < m_box[1] + m_box[3]);
        gl.Enable(GL_SCISSOR_TEST);
        gl.Scissor(pixel.x, pixel.y, 1, 1);
    }
    ~OnePixel() {
        if (!m_had_scissor) m_gl.Disable(GL_SCISSOR_TEST);
        m_gl.Scissor(m_box[0], m_box[1], m_box[2], m_box[3]);
    }
    OnePixel(const OnePixel&) = delete;
    OnePixel& operator=(const OnePixel&) = delete;

    bool is_inside() const { return m_is_inside; }

  private:
    const gl::Functions& m_gl;
    bool m_had_scissor, m_is_inside = true;
    std::array<GLint, 4> m_box{};
};

bool draws_samples(const gl::Functions& gl) {
    GLint samples = 0;
    gl.GetIntegerv(GL_SAMPLES, &samples);
    return samples > 1;
}

bool occlusion_query_runs(const gl::Functions& gl) {
    for (const GLenum target : {GL_SAMPLES_PASSED, GL_ANY_SAMPLES_PASSED, GL_ANY_SAMPLES_PASSED_CONSERVATIVE}) {
        GLint query = 0;
        gl.GetQueryiv(target, GL_CURRENT_QUERY, &query);
        if (query != 0) return true;
    }
    return false;
}

std::vector<std::size_t> numbers_if(const std::vector<PixelTrace::Fragment>& fragments, bool passed) {
    std::vector<std::size_t> numbers;
    for (const PixelTrace::Fragment& fragment : fragments)
        if (fragment.passed == passed) numbers.push_back(fragment.number);
    return numbers;
}

}  // namespace

PixelFact number_fact(const std::string& name, double value, const std::string& text) {
    return {name, "number", value, text};
}

PixelFact color_fact(const std::string& name, const glm::vec3& color, const std::string& text) {
    return {name, "color", {color.r, color.g, color.b}, text};
}

PixelFact fragment_fact(const std::string& name, std::optional<std::size_t> number, const std::string& text) {
    return {name, "fragment", number ? nlohmann::json(*number) : nlohmann::json(), text};
}

PixelFact fragments_fact(const std::string& name, const std::vector<std::size_t>& numbers, const std::string& text) {
    return {name, "fragments", numbers, text};
}

std::vector<std::size_t> PixelTrace::Draws::passed() const {
    return numbers_if(fragments, true);
}

std::vector<std::size_t> PixelTrace::Draws::failed() const {
    return numbers_if(fragments, false);
}

std::optional<std::size_t> PixelTrace::Draws::last_passed() const {
    const std::vector<std::size_t> numbers = passed();
    return numbers.empty() ? std::nullopt : std::optional(numbers.back());
}

PixelTrace::PixelTrace(const gl::Functions& gl, Scene& scene, glm::ivec2 size_px, glm::ivec2 pixel,
                       std::vector<Surface> fragments, double opaque_depth)
    : m_gl(gl),
      m_scene(scene),
      m_size_px(size_px),
      m_pixel(pixel),
      m_fragments(std::move(fragments)),
      m_opaque_depth(opaque_depth) {
    for (std::size_t i = 0; i < m_fragments.size(); ++i) m_numbers[m_fragments[i].primitive] = i + 1;
    m_scene.observe(this);
}

PixelTrace::~PixelTrace() {
    m_scene.observe(nullptr);
}

PixelTrace::Draws PixelTrace::of(const gl::Program& program) const {
    Draws draws;
    const auto found = m_records.find(program.id());
    if (found == m_records.end()) return draws;
    for (const Step& step : found->second.steps) {
        GLuint passed = 0;
        m_gl.GetQueryObjectuiv(step.query.id(), GL_QUERY_RESULT, &passed);
        draws.fragments.push_back({step.number, passed != 0});
    }
    draws.color = found->second.color;
    return draws;
}

std::optional<std::size_t> PixelTrace::at_depth(double depth) const {
    std::optional<std::size_t> number;
    double least = std::abs(m_opaque_depth - depth);
    for (std::size_t i = 0; i < m_fragments.size(); ++i) {
        const double distance = std::abs(m_fragments[i].depth - depth);
        if (distance >= least) continue;
        least = distance;
        number = i + 1;
    }
    return number;
}

void PixelTrace::draw_transparent(const gl::Program& program, Order order, std::size_t first, std::size_t count) {
    std::array<GLint, 4> viewport{};
    m_gl.GetIntegerv(GL_VIEWPORT, viewport.data());
    // If the picture is smaller, the pixel that covers the requested one.
    const glm::ivec2 pixel = m_pixel * glm::ivec2(viewport[2], viewport[3]) / m_size_px;
    const OnePixel one(m_gl, pixel);
    if (!one.is_inside()) return;
    if (draws_samples(m_gl) || occlusion_query_runs(m_gl)) return m_scene.draw_unobserved(program, order, first, count);
    Record& record = m_records[program.id()];
    draw_steps(program, order, first, count, record);
    record.color = color_now(pixel);
}

void PixelTrace::draw_steps(const gl::Program& program, Order order, std::size_t first, std::size_t count,
                            Record& record) {
    std::size_t drawn = first;
    for (std::size_t i = first; i < first + count; ++i) {
        const auto number = m_numbers.find(m_scene.primitive_at(order, i));
        if (number == m_numbers.end()) continue;
        if (i > drawn) m_scene.draw_unobserved(program, order, drawn, i - drawn);
        gl::Query query = gl::make_query(m_gl, "pixel trace", GL_ANY_SAMPLES_PASSED);
        m_gl.BeginQuery(GL_ANY_SAMPLES_PASSED, query.id());
        m_scene.draw_unobserved(program, order, i, 1);
        m_gl.EndQuery(GL_ANY_SAMPLES_PASSED);
        record.steps.push_back({number->second, std::move(query)});
        drawn = i + 1;
    }
    if (first + count > drawn) m_scene.draw_unobserved(program, order, drawn, first + count - drawn);
}

std::optional<glm::vec4> PixelTrace::color_now(glm::ivec2 pixel) const {
    GLint buffer = GL_NONE;
    m_gl.GetIntegerv(GL_READ_BUFFER, &buffer);
    if (buffer == GL_NONE) return std::nullopt;
    glm::vec4 color(0);
    m_gl.ReadPixels(pixel.x, pixel.y, 1, 1, GL_RGBA, GL_FLOAT, &color[0]);
    return color;
}

}  // namespace sheer
