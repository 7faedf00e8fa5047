#pragma once
#include "renderer/compare/compare.h"

namespace sheer {

/// Compares the picture of each method that has its own look with that of its counterpart: the method of the same id
/// and parameters that draws the scene's own look, or without one the first of the same id and parameters in the spec.
void compare_with_counterparts(Run& run);

}  // namespace sheer
