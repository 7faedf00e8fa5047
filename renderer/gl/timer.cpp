#include "renderer/gl/timer.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "renderer/gl/objects.h"

namespace sheer::gl {
namespace {

using Clock = std::chrono::steady_clock;

/// Below this the constant cost of a query and of the two glFinish is more than the tolerance.
constexpr double min_comparable_ms = 5;
constexpr double clock_tolerance = 0.1;

bool clocks_agree(const FrameSample& sample) {
    if (sample.wall_ms <= min_comparable_ms) return true;
    return std::abs(sample.gpu_ms - sample.wall_ms) <= clock_tolerance * sample.wall_ms;
}

}  // namespace

/// Where the time stamps of `flush-timer-queries` are rasterised. The begin of a query is stamped per tile of the
/// framebuffer that the driver used last, which may have no tile at all: then there is no stamp, and the result is the
/// time since the machine started. Clearing this framebuffer makes it the last one and does not change GL's binding.
class FrameTimer::StampTarget {
  public:
    explicit StampTarget(const Functions& gl) : m_gl(gl), m_color(make_texture_2d(gl, "timer stamps", GL_RGBA8, 1, 1)) {
        const std::array colors{m_color.id()};
        m_framebuffer = make_framebuffer(gl, "timer stamps", colors, 0);
    }

    void use() const {
        constexpr std::array<GLfloat, 4> black{};
        m_gl.ClearNamedFramebufferfv(m_framebuffer.id(), GL_COLOR, 0, black.data());
    }

  private:
    const Functions& m_gl;
    Texture m_color;
    Framebuffer m_framebuffer;
};

struct FrameTimer::State {
    explicit State(const Functions& functions) : gl(functions) {}

    const Functions& gl;
    std::optional<StampTarget> stamps;  ///< only with the workaround
    std::vector<Query> queries;         ///< one for each pass of the longest frame so far
    FrameSample sample;
    Clock::time_point start;
    bool in_frame = false;
    bool in_pass = false;
    bool timed = false;

    void begin_query() {
        const std::size_t number = sample.passes.size() - 1;
        if (number == queries.size()) queries.push_back(make_query(gl, "pass time", GL_TIME_ELAPSED));
        if (stamps) stamps->use();
        gl.BeginQuery(GL_TIME_ELAPSED, queries[number].id());
        if (stamps) gl.Flush();
    }

    void read_clocks() {
        sample.wall_ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
        for (std::size_t i = 0; i < sample.passes.size(); ++i) {
            GLuint64 elapsed_ns = 0;
            gl.GetQueryObjectui64v(queries[i].id(), GL_QUERY_RESULT, &elapsed_ns);
            sample.passes[i].gpu_ms = static_cast<double>(elapsed_ns) * 1e-6;
            sample.gpu_ms += sample.passes[i].gpu_ms;
        }
        sample.valid = clocks_agree(sample);
    }
};

FrameTimer::FrameTimer(const Context& context) : m_state(new State(context.gl())) {
    if (context.workarounds().has("flush-timer-queries")) m_state->stamps.emplace(context.gl());
}

FrameTimer::~FrameTimer() = default;

FrameTimer::Pass::Pass(Pass&& other) noexcept : m_timer(std::exchange(other.m_timer, nullptr)) {}

FrameTimer::Pass::~Pass() {
    if (m_timer != nullptr) m_timer->end_pass();
}

FrameTimer::Frame::Frame(Frame&& other) noexcept : m_timer(std::exchange(other.m_timer, nullptr)) {}

FrameTimer::Frame::~Frame() {
    if (m_timer != nullptr) m_timer->end_frame();
}

FrameSample FrameTimer::Frame::end() {
    if (m_timer == nullptr || m_timer->m_state->in_pass)
        throw std::logic_error("a frame is ended twice or within a pass");
    State& state = *std::exchange(m_timer, nullptr)->m_state;
    state.in_frame = false;
    state.gl.Finish();
    if (state.timed) state.read_clocks();
    return std::exchange(state.sample, {});
}

FrameTimer::Frame FrameTimer::frame(bool timed) {
    if (m_state->in_frame) throw std::logic_error("a frame within a frame");
    m_state->in_frame = true;
    m_state->timed = timed;
    m_state->sample = {};
    if (timed) {
        m_state->gl.Finish();
        m_state->start = Clock::now();
    }
    return Frame(this);
}

FrameTimer::Pass FrameTimer::pass(std::string name, Phase phase) {
    if (!m_state->in_frame) throw std::logic_error("pass outside of a frame: " + name);
    if (m_state->in_pass) throw std::logic_error("pass within a pass: " + name);
    const auto size = static_cast<GLsizei>(std::min(name.size(), max_label_bytes));
    m_state->gl.PushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, size, name.data());
    m_state->in_pass = true;
    m_state->sample.passes.push_back({std::move(name), phase, 0});
    if (m_state->timed) m_state->begin_query();
    return Pass(this);
}

void FrameTimer::end_pass() {
    if (m_state->timed) m_state->gl.EndQuery(GL_TIME_ELAPSED);
    m_state->gl.PopDebugGroup();
    m_state->in_pass = false;
}

void FrameTimer::end_frame() {
    m_state->in_frame = false;
    m_state->gl.Finish();
}

}  // namespace sheer::gl
