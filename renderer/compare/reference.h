#pragma once
#include "renderer/compare/workbench.h"

namespace sheer {

/// Renders the reference of the spec into `run`, in 32-bit floats regardless of the format of the methods' target;
/// counts the fragments of the scene, and compares the reference with depth peeling, an independent method. Without a
/// reference the methods are still timed and counted. Returns the reference over other backgrounds.
Backdrops render_reference(const Spec& spec, const Scene& scene, Workbench& bench, Run& run);

}  // namespace sheer
