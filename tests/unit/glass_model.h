#pragma once
#include <string>

namespace sheer::test {

/// configs/models/glass.glb: a still life of glass on a table. Bottles, a flask and a tumbler blend, two of them with
/// something in them; the cloth is masked; the table and the fruit are opaque. The same bytes on every platform.
std::string make_glass_model();

}  // namespace sheer::test
