#pragma once
#include "renderer/frame/target.h"
#include "renderer/gl/context.h"
#include "renderer/gl/objects.h"
#include "renderer/scene/scene.h"
#include "renderer/spec/spec.h"

namespace sheer {

/// Runs the user's own shading once for every fragment of the scene, hidden ones too. Throws SpecError at
/// /scene/shading/glsl if the loops of any want more than iterations_per_fragment. Nothing is drawn where there are no
/// loops.
void check_loops(const gl::Functions& gl, const Scene& scene, const ImageSpec& image);

/// Draws a frame of the method and throws the same if the loops of any fragment that it shades want more: at its edges
/// a method of several samples per pixel, or one that draws a smaller picture too, shades other places than check_loops
/// does. A method that this device cannot run is passed over.
void check_loops_of(const MethodSpec& method, const gl::Context& context, Scene& scene, const Target& target,
                    gl::FrameTimer& timer);

}  // namespace sheer
