#pragma once
#include <string>

namespace sheer::test {

/// configs/specs/glass.glb: a still life of glass on a table. Bottles, a flask and a tumbler are blended, two of them
/// have contents; the cloth is masked; the table and the fruit are opaque. The same bytes on every platform.
std::string make_glass_model();

}  // namespace sheer::test
