#pragma once
#include <functional>
#include <string>

#include "renderer/gl/objects.h"
#include "renderer/passes/target.h"
#include "renderer/scene/scene.h"

namespace sheer {

/// Runs the user's own shading once for every fragment of the scene, hidden ones too. Throws SpecError at
/// Scene::glsl_pointer() if the loops of any need more than iterations_per_fragment. Nothing is drawn if there are no
/// loops.
void check_loops(const gl::Functions& gl, const Scene& scene, const ImageSpec& image);

/// Calls `draw`, which makes the method `name` and draws a frame of it, and throws the same error if the loops of any
/// fragment that it shades need more: at edges, a method with several samples per pixel, or one that also draws a
/// smaller picture, shades other places than check_loops does. If the method is Unsupported or fails, that is ignored:
/// it will fail again when its picture is rendered.
void check_loops_of(const std::string& name, const gl::Functions& gl, Scene& scene, const std::function<void()>& draw);

}  // namespace sheer
