#pragma once
#include <string>
#include <vector>

#include "renderer/litmus/over.h"

namespace sheer::litmus {

inline constexpr int litmus_size_px = 16;

/// A rectangle whose edges are on pixel corners, facing the viewer, or turned so that its depth changes from left to
/// right.
struct LitmusSurface {
    std::array<double, 4> rect = {0, 0, 1, 1};  ///< corners in fractions of the picture, origin top left, y down
    double left_depth = 0.5, right_depth = 0.5;
    Color color = {};
    double alpha = 1;
    bool opaque = false;  ///< drawn before the others, without blending

    bool is_turned() const { return left_depth != right_depth; }
};

/// A scene that can be worked out by hand: what is submitted, in its order.
struct LitmusScene {
    std::string id;
    Color background = {0.1, 0.15, 0.05};
    std::vector<LitmusSurface> surfaces;
    /// The correct picture, if it is not that of the over operator.
    Formula intended = over_by_depth;
    /// Methods are to keep sums as 16-bit floats.
    bool in_16_bits = false;

    /// The layers of a spec's `layers` scene. A surface that is turned is one layer for each column of pixels, at its
    /// depth in the middle of that column.
    nlohmann::json layers() const;
    /// The contents of its pixels.
    Compositor truth() const;
    /// The same if each surface has the depth of its middle, by which primitives are sorted.
    Compositor as_sorted() const;

  private:
    Compositor compositor(bool at_middles) const;
    nlohmann::json layers(bool at_middles) const;
};

/// What is said about a scene to people.
struct LitmusSceneInfo {
    std::string id, name, what;
    std::vector<std::string> scene_ids;  ///< of the scenes that belong to it: its own, or several orders of submission
};

/// In the order of docs/litmus.md.
const std::vector<LitmusSceneInfo>& litmus_scene_infos();

/// By its id. Throws std::invalid_argument if there is none.
LitmusScene litmus_scene(const std::string& id);

/// Every scene of every LitmusSceneInfo.
std::vector<LitmusScene> all_litmus_scenes();

}  // namespace sheer::litmus
