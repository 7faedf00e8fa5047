#pragma once
#include <cstdint>
#include <vector>

#include "renderer/gl/objects.h"
#include "renderer/scene/scene_info.h"

namespace sheer {

/// What an engine must do in every frame to draw a scene's transparent primitives in depth order after the camera has
/// moved: compute a key for each, radix-sort the keys, write the indices in that order, and upload them.
///
/// The orders of Scene are made once, so no timed frame includes them. This sort has a buffer of its own, which is
/// never drawn.
class DepthSort {
  public:
    /// `gl` outlives it. The geometry must have a transparent primitive.
    DepthSort(const gl::Functions& gl, const Geometry& geometry);

    /// Sorts far to near, primitives of equal depth in the order of submission, as Scene does, and waits until the
    /// device has the indices. The camera is turned around the scene's middle by `turn_rad`; scenes without a camera
    /// are not turned.
    void sort(double turn_rad);
    /// Wall time of a sort in ms, from idle device to idle device, with the camera a degree further each time.
    double time_next_ms();

    /// The sorted primitives, numbered among the transparent ones in the order of submission.
    std::vector<std::uint32_t> order() const;
    /// The indices that were last uploaded.
    const std::vector<std::uint32_t>& indices() const { return m_sorted; }

  private:
    struct Entry {
        std::uint32_t key, primitive;
    };
    void make_keys(const glm::vec3& axis);
    void sort_keys();
    void write_indices();

    const gl::Functions& m_gl;
    glm::vec3 m_axis, m_side;  ///< depth grows along the axis; the camera turns towards the side
    bool m_turns;
    std::vector<glm::vec3> m_centres;
    std::vector<std::uint32_t> m_indices, m_first_index;  ///< in the order of submission; one past the last
    std::vector<Entry> m_entries, m_scratch;
    std::vector<std::uint32_t> m_sorted;
    gl::Buffer m_buffer;
    int m_turns_done = 0;
};

}  // namespace sheer
