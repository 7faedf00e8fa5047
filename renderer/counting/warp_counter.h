#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "renderer/gl/objects.h"
#include "renderer/scene/scene.h"

namespace sheer {

/// Groups of fragments that a GPU shades together, over all draws of a frame: 2 x 2 pixels of a primitive are a quad, 8
/// x 4 are a warp, 32 threads which end together. A warp is live if the shading runs for any of its fragments. (Vlcek,
/// Havel, Herout, SCCG 2010, section 2.3.)
struct WarpCounts {
    std::int64_t warps = 0, live_warps = 0;
    std::int64_t quads = 0, live_quads = 0;
};

/// Counts them, for ShadingCounter: its programs set a bit for each fragment that starts, and another one if the
/// shading runs for it, in words that each primitive has for the blocks of 8 x 4 pixels in its screen rectangle. A
/// primitive of several triangles fills its warps together.
///
/// What does not fit into a storage buffer is counted in several frames, each with a window of the primitives.
class WarpCounter {
  public:
    WarpCounter(const gl::Functions& gl, const Scene& scene, int width_px, int height_px);

    /// Frames that are needed; 0 if there are too many primitives, or too large ones. Then it counts nothing.
    std::size_t windows() const { return m_windows.size(); }
    /// Why there is no window; "" if there is one.
    const std::string& reason() const { return m_reason; }
    void choose_window(std::size_t window);

    /// Before each draw that is counted: a primitive that has been drawn before begins new warps.
    void begin_draw(Order order, std::size_t first, std::size_t count);
    void count_in(const gl::Program& program) const;

    /// Waits for the device.
    WarpCounts read();

  private:
    struct Window {
        std::uint32_t first_primitive;
        std::vector<std::uint32_t> table;  ///< four words for each primitive
        std::uint32_t words;               ///< for the blocks of all of them
    };

    void divide();
    /// Adds what has been marked since the last flush.
    void flush();
    std::uint32_t begin_of_words() const { return static_cast<std::uint32_t>(m_windows[m_window].table.size()); }

    const gl::Functions& m_gl;
    const Scene& m_scene;
    int m_width_px, m_height_px;
    std::string m_reason;
    std::vector<Window> m_windows;
    std::size_t m_window = 0;
    std::vector<bool> m_drawn;  ///< since the last flush, by primitive
    gl::Buffer m_words, m_sums;
    gl::Program m_program;
    WarpCounts m_counts;
};

}  // namespace sheer
