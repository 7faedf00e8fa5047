#include "renderer/counting/warp_counter.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace sheer {

namespace {

/// As in shaders/scenes/count_shaded.glsl and common/count_warps.comp.glsl.
constexpr GLuint words_binding = 8, sums_binding = 9;
constexpr std::uint32_t table_words = 4;
constexpr int block_width_px = 8, block_height_px = 4;

constexpr std::size_t most_windows = 16;
/// Larger buffers would gain nothing but memory.
constexpr std::int64_t most_bytes = std::int64_t{128} << 20;
constexpr GLuint groups = 64;

/// The top left corner, which is where the renderer's pictures begin, and the number of blocks; none if nothing is in
/// the picture.
struct Blocks {
    std::uint32_t left_px = 0, top_px = 0, columns = 0, rows = 0;

    std::uint32_t words() const { return 2 * columns * rows; }
};

/// With a pixel more on each side, as samples outside of a primitive's centers may be covered.
Blocks blocks_of(const glm::vec4& rect, int width_px, int height_px) {
    const auto pixel = [](float place, int size_px, int more) {
        const float at = std::floor(std::clamp(place, -1.0f, 2.0f) * static_cast<float>(size_px));
        return static_cast<int>(at) + more;
    };
    const int left = std::max(0, pixel(rect.x, width_px, -1)),
              right = std::min(width_px - 1, pixel(rect.z, width_px, 1));
    const int top = std::max(0, pixel(rect.y, height_px, -1)),
              bottom = std::min(height_px - 1, pixel(rect.w, height_px, 1));
    if (left > right || top > bottom) return {};
    return {static_cast<std::uint32_t>(left), static_cast<std::uint32_t>(top),
            static_cast<std::uint32_t>(right / block_width_px - left / block_width_px + 1),
            static_cast<std::uint32_t>(bottom / block_height_px - top / block_height_px + 1)};
}

}  // namespace

WarpCounter::WarpCounter(const gl::Functions& gl, const Scene& scene, int width_px, int height_px)
    : m_gl(gl), m_scene(scene), m_width_px(width_px), m_height_px(height_px) {
    GLint bindings = 0;
    gl.GetIntegerv(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS, &bindings);
    if (bindings <= static_cast<GLint>(sums_binding)) {
        m_reason = fmt::format("the device has only {} storage buffers", bindings);
        return;
    }
    divide();
    if (m_windows.empty()) return;
    m_drawn.resize(scene.screen_rects().size());
    std::size_t most_words = 0;
    for (const Window& window : m_windows) most_words = std::max(most_words, window.table.size() + window.words);
    m_words = gl::make_buffer(gl, "warps", static_cast<GLsizeiptr>(most_words * sizeof(std::uint32_t)), nullptr,
                              GL_DYNAMIC_STORAGE_BIT);
    const std::array<std::uint32_t, 4> zero{};
    m_sums = gl::make_buffer(gl, "sums of warps", sizeof zero, zero.data(), GL_DYNAMIC_STORAGE_BIT);
    m_program = gl::Program::compute(gl, "count warps", glsl_version + gl::shader_file("common/count_warps.comp.glsl"));
    choose_window(0);
}

void WarpCounter::divide() {
    GLint64 largest_block = 0;
    m_gl.GetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &largest_block);
    const auto most_words = static_cast<std::uint64_t>(std::min<std::int64_t>(largest_block, most_bytes)) / 4;
    const std::vector<glm::vec4>& rects = m_scene.screen_rects();
    std::vector<bool> transparent(rects.size());
    for (std::size_t place = 0; place < m_scene.transparent_count(); ++place)
        transparent[m_scene.primitive_at(Order::submission, place)] = true;
    for (std::size_t i = 0; i < rects.size(); ++i) {
        const Blocks blocks = transparent[i] ? blocks_of(rects[i], m_width_px, m_height_px) : Blocks{};
        const bool full =
            !m_windows.empty() &&
            m_windows.back().table.size() + table_words + m_windows.back().words + blocks.words() > most_words;
        if (m_windows.empty() || full) m_windows.push_back({static_cast<std::uint32_t>(i), {}, 0});
        Window& window = m_windows.back();
        window.table.insert(window.table.end(),
                            {window.words, blocks.left_px, blocks.top_px, blocks.columns | blocks.rows << 16});
        window.words += blocks.words();
    }
    for (Window& window : m_windows)
        for (std::size_t entry = 0; entry < window.table.size(); entry += table_words)
            window.table[entry] += static_cast<std::uint32_t>(window.table.size());
    if (m_windows.size() <= most_windows) return;
    m_reason = fmt::format("it would take {} frames to count them; the limit is {}", m_windows.size(), most_windows);
    m_windows.clear();
}

void WarpCounter::choose_window(std::size_t window) {
    if (m_windows.empty()) return;
    if (window != m_window) flush();
    m_window = window;
    const std::uint32_t zero = 0;
    m_gl.ClearNamedBufferData(m_words.id(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &zero);
    const std::vector<std::uint32_t>& table = m_windows[window].table;
    m_gl.NamedBufferSubData(m_words.id(), 0, static_cast<GLsizeiptr>(table.size() * sizeof table[0]), table.data());
    m_drawn.assign(m_drawn.size(), false);
}

void WarpCounter::begin_draw(Order order, std::size_t first, std::size_t count) {
    if (m_windows.empty()) return;
    for (std::size_t place = first; place < first + count; ++place)
        if (m_drawn[m_scene.primitive_at(order, place)]) {
            flush();
            break;
        }
    for (std::size_t place = first; place < first + count; ++place) m_drawn[m_scene.primitive_at(order, place)] = true;
}

void WarpCounter::count_in(const gl::Program& program) const {
    if (m_windows.empty()) return program.set("u_warp_primitives", 0u);
    program.set("u_first_warp_primitive", static_cast<unsigned>(m_windows[m_window].first_primitive));
    program.set("u_warp_primitives", static_cast<unsigned>(m_windows[m_window].table.size() / table_words));
    m_gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, words_binding, m_words.id());
}

void WarpCounter::flush() {
    m_gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    m_gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, words_binding, m_words.id());
    m_gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, sums_binding, m_sums.id());
    m_program.set("u_begin", static_cast<unsigned>(begin_of_words()));
    m_program.set("u_end", static_cast<unsigned>(begin_of_words() + m_windows[m_window].words));
    m_program.use();
    m_gl.DispatchCompute(groups, 1, 1);
    m_gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    std::array<std::uint32_t, 4> sums{};
    m_gl.GetNamedBufferSubData(m_sums.id(), 0, sizeof sums, sums.data());
    m_counts.warps += sums[0];
    m_counts.live_warps += sums[1];
    m_counts.quads += sums[2];
    m_counts.live_quads += sums[3];
    sums = {};
    m_gl.NamedBufferSubData(m_sums.id(), 0, sizeof sums, sums.data());
    m_drawn.assign(m_drawn.size(), false);
}

WarpCounts WarpCounter::read() {
    if (!m_windows.empty()) flush();
    return m_counts;
}

}  // namespace sheer
