#pragma once
#include <string>

#include "renderer/passes/overdraw.h"
#include "renderer/scene/scene_info.h"

namespace sheer {

/// Why the picture has nothing in which the methods could differ, as a sentence; "" if there is something. `overdraw`
/// is that of the scene, which is made of `geometry` and has a type that names its transparent parts.
std::string why_nothing_is_drawn(const gl::Functions& gl, const Scene& scene, const Geometry& geometry,
                                 const SceneInfo& type, const Target& target, const PixelCounts& overdraw,
                                 gl::FrameTimer& timer);

}  // namespace sheer
