#pragma once
#include <cstdint>
#include <vector>

#include "renderer/gl/objects.h"
#include "renderer/scene/scene_info.h"

namespace sheer {

/// What an engine pays in every frame to draw a scene's transparent primitives in the order of their depths from a
/// camera that has moved: a key for each, a radix sort of the keys, the indices in that order, and their upload.
///
/// The orders of Scene are made once, so no timed frame pays for them. This sort has a buffer of its own and is drawn
/// by nobody.
class DepthSort {
  public:
    /// `gl` outlives it. The geometry must have a transparent primitive.
    DepthSort(const gl::Functions& gl, const Geometry& geometry);

    /// Sorts far to near, primitives of equal depth in the order of submission, as Scene does, and waits until the
    /// device has the indices. The camera is turned around the scene's middle by `turn_rad`; scenes without one are not
    /// turned.
    void sort(double turn_rad);
    /// Wall time of that in ms, from an idle device to an idle device, with the camera a degree further each time.
    double time_next_ms();

    /// The sorted primitives, numbered among the transparent ones in the order of submission.
    std::vector<std::uint32_t> order() const;
    /// What was uploaded last.
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
