#pragma once
#include <string>

#include "renderer/gl/context.h"

namespace sheer {

/// Compiles the user's own shading, the body of real_work, for this device. Returns what its compiler says of it, with
/// the user's lines; "" if it compiles. Throws RenderError for any other trouble.
std::string compile_shading(gl::Context& context, const std::string& glsl);

}  // namespace sheer
