#pragma once
#include "renderer/gl/objects.h"
#include "renderer/scene/scene.h"
#include "renderer/spec/spec.h"

namespace sheer {

/// Runs the user's own shading once for every fragment of the scene, hidden ones too. Throws SpecError at
/// /scene/shading/glsl if the loops of any want more than iterations_per_fragment. Nothing is drawn where there are no
/// loops.
void check_loops(const gl::Functions& gl, const Scene& scene, const ImageSpec& image);

}  // namespace sheer
