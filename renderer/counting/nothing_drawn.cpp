#include "renderer/counting/nothing_drawn.h"

#include <fmt/format.h>

#include <algorithm>

namespace sheer {

namespace {

/// Whether all corners of the primitive are beyond one plane of the view.
bool is_outside(const Geometry& geometry, const Primitive& primitive) {
    const auto begin = geometry.indices.begin() + primitive.first_index, end = begin + primitive.index_count;
    const auto all = [&](const auto& beyond) {
        return std::all_of(begin, end, [&](std::uint32_t index) {
            return beyond(geometry.view_projection * glm::vec4(geometry.vertices[index].position, 1));
        });
    };
    for (int axis = 0; axis < 3; ++axis) {
        const bool low = all([&](const glm::vec4& at) { return axis == 2 ? at.z < 0 : at[axis] < -at.w; });
        if (low || all([&](const glm::vec4& at) { return at[axis] > at.w; })) return true;
    }
    return false;
}

bool all_outside(const Geometry& geometry) {
    return std::ranges::all_of(geometry.primitives, [&](const Primitive& primitive) {
        return primitive.opaque || is_outside(geometry, primitive);
    });
}

std::string cause(const gl::Functions& gl, const Scene& scene, const Geometry& geometry, const SceneInfo& type,
                  const Target& target, const PixelCounts& overdraw, gl::FrameTimer& timer) {
    if (scene.transparent_count() == 0) return fmt::format("the scene has no {}", type.transparent);
    if (overdraw.total() > 0) {
        const bool visible = count_visible(gl, scene, target, timer).total() > 0;
        return visible ? "" : "all of it has an alpha of 0";
    }
    if (all_outside(geometry)) return "all of it is outside the camera's view";
    if (count_behind_opaque(gl, scene, target, timer).total() > 0) return "opaque geometry hides all of it";
    return "it covers no pixel's centre, or only its back faces are in view";
}

}  // namespace

std::string why_nothing_is_drawn(const gl::Functions& gl, const Scene& scene, const Geometry& geometry,
                                 const SceneInfo& type, const Target& target, const PixelCounts& overdraw,
                                 gl::FrameTimer& timer) {
    const std::string why = cause(gl, scene, geometry, type, target, overdraw, timer);
    return why.empty() ? "" : fmt::format("Nothing transparent was drawn: {}.", why);
}

}  // namespace sheer
