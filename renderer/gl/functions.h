#pragma once
#include <glad/gl.h>

#include <functional>

namespace sheer::gl {

/// The functions of OpenGL 4.5 core as members: `gl.BindFramebuffer(...)`. glad makes this table from the
/// specification; see cmake/gl_loader.cmake. A driver need not have those that Sheer never calls; they are then null.
using Functions = GladGLContext;

/// Returns the address of a GL function by its full name ("glClear"), or null.
using Resolver = std::function<void*(const char*)>;

/// The functions of the current context. Throws RenderError naming the first one that Sheer calls but the driver lacks.
Functions load_functions(const Resolver& resolve);

}  // namespace sheer::gl
