#pragma once
#include <GL/glcorearb.h>

#include <functional>

namespace sheer::gl {

/// The OpenGL functions that Sheer calls, as members: `gl.BindTexture(...)`. The list is functions.def.
///
/// No packaged loader serves EGL, OSMesa and GLFW alike: libepoxy asserts on an OSMesa context, GLEW and glbinding
/// resolve through GLX, glad is not packaged.
struct Functions {
#define SHEER_GL_FUNCTION(type, name) type name = nullptr;
#define SHEER_GL_OPTIONAL(type, name) type name = nullptr;
#include "renderer/gl/functions.def"
#undef SHEER_GL_FUNCTION
#undef SHEER_GL_OPTIONAL
};

/// Gives the address of a GL function by its full name ("glClear"), or null.
using Resolver = std::function<void*(const char*)>;

/// Throws RenderError naming the first function that is missing; optional ones stay null.
Functions load_functions(const Resolver& resolve);

}  // namespace sheer::gl
