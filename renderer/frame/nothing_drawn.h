#pragma once
#include <string>

#include "renderer/frame/overdraw.h"
#include "renderer/scene/scene_info.h"

namespace sheer {

/// Why there is nothing in the picture for the methods to differ in, as a sentence; "" where there is something.
/// `overdraw` is that of the scene, which is made of `geometry` and of a type that says what of it is transparent.
std::string why_nothing_is_drawn(const gl::Functions& gl, const Scene& scene, const Geometry& geometry,
                                 const SceneInfo& type, const Target& target, const PixelCounts& overdraw,
                                 gl::FrameTimer& timer);

}  // namespace sheer
