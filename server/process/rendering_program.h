#pragma once
#include <string>

namespace sheer {

/// The program whose commands draw and decode pictures: `sheer-render` beside `sheer`, which is linked with no OpenGL
/// and no picture library. Any other program that asks has these commands itself.
std::string rendering_program();

}  // namespace sheer
