#include "renderer/scene/depth_sort.h"

#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <utility>

namespace sheer {

namespace {

constexpr double degrees_per_frame = 1;
constexpr int digit_bits = 11, digit_count = 3;  // 33 bits hold a key of 32
constexpr std::uint32_t digit_mask = (1u << digit_bits) - 1;

/// A number that grows as `depth` falls, so that an ascending sort is far to near.
std::uint32_t key_of(float depth) {
    const auto bits = std::bit_cast<std::uint32_t>(depth);
    const bool negative = (bits & 0x80000000u) != 0;
    return negative ? bits : ~(bits | 0x80000000u);
}

/// The direction in the vertices' space in which depth grows: that of w with perspective, otherwise that of z.
glm::vec3 depth_axis(const glm::mat4& view_projection) {
    const auto row = [&](int i) {
        return glm::vec3(view_projection[0][i], view_projection[1][i], view_projection[2][i]);
    };
    const glm::vec3 axis = row(3) == glm::vec3(0) ? row(2) : row(3);
    return glm::normalize(axis);
}

}  // namespace

DepthSort::DepthSort(const gl::Functions& gl, const Geometry& geometry)
    : m_gl(gl), m_axis(depth_axis(geometry.view_projection)), m_turns(!geometry.camera.is_null()) {
    const glm::vec3 other = std::abs(m_axis.x) < 0.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    m_side = glm::normalize(glm::cross(m_axis, other));
    for (const Primitive& primitive : geometry.primitives) {
        if (primitive.opaque) continue;
        m_first_index.push_back(static_cast<std::uint32_t>(m_indices.size()));
        const auto first = geometry.indices.begin() + primitive.first_index;
        m_indices.insert(m_indices.end(), first, first + primitive.index_count);
        glm::vec3 sum(0);
        for (auto index = first; index != first + primitive.index_count; ++index)
            sum += geometry.vertices[*index].position;
        m_centres.push_back(sum / static_cast<float>(primitive.index_count));
    }
    m_first_index.push_back(static_cast<std::uint32_t>(m_indices.size()));
    m_entries.resize(m_centres.size());
    m_scratch.resize(m_centres.size());
    m_sorted.resize(m_indices.size());
    m_buffer =
        gl::make_buffer(gl, "newly sorted indices", static_cast<GLsizeiptr>(m_indices.size() * sizeof(m_indices[0])),
                        nullptr, GL_DYNAMIC_STORAGE_BIT);
}

void DepthSort::sort(double turn_rad) {
    const double turn = m_turns ? turn_rad : 0;
    make_keys(m_axis * static_cast<float>(std::cos(turn)) + m_side * static_cast<float>(std::sin(turn)));
    sort_keys();
    write_indices();
    m_gl.NamedBufferSubData(m_buffer.id(), 0, static_cast<GLsizeiptr>(m_sorted.size() * sizeof(m_sorted[0])),
                            m_sorted.data());
    m_gl.Finish();
}

double DepthSort::time_next_ms() {
    const double turn_rad = ++m_turns_done * glm::radians(degrees_per_frame);
    m_gl.Finish();
    const auto begin = std::chrono::steady_clock::now();
    sort(turn_rad);
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

std::vector<std::uint32_t> DepthSort::order() const {
    std::vector<std::uint32_t> primitives;
    for (const Entry& entry : m_entries) primitives.push_back(entry.primitive);
    return primitives;
}

void DepthSort::make_keys(const glm::vec3& axis) {
    for (std::size_t i = 0; i < m_centres.size(); ++i)
        m_entries[i] = {key_of(glm::dot(axis, m_centres[i])), static_cast<std::uint32_t>(i)};
}

/// Least significant digit first, which keeps the order of equal keys.
void DepthSort::sort_keys() {
    std::array<std::array<std::uint32_t, digit_mask + 1>, digit_count> places{};
    for (const Entry& entry : m_entries)
        for (int digit = 0; digit < digit_count; ++digit)
            ++places[digit][(entry.key >> (digit * digit_bits)) & digit_mask];
    for (int digit = 0; digit < digit_count; ++digit) {
        std::uint32_t place = 0;
        for (std::uint32_t& count : places[digit]) place += std::exchange(count, place);
        for (const Entry& entry : m_entries)
            m_scratch[places[digit][(entry.key >> (digit * digit_bits)) & digit_mask]++] = entry;
        m_entries.swap(m_scratch);
    }
}

void DepthSort::write_indices() {
    std::uint32_t* to = m_sorted.data();
    for (const Entry& entry : m_entries)
        for (std::uint32_t i = m_first_index[entry.primitive]; i < m_first_index[entry.primitive + 1]; ++i)
            *to++ = m_indices[i];
}

}  // namespace sheer
