#include "renderer/gl/functions.h"

#include <fmt/format.h>

#include "renderer/errors.h"

namespace sheer::gl {
namespace {

template <typename Pointer>
void load_optional(const Resolver& resolve, Pointer& function, const char* name) {
    function = reinterpret_cast<Pointer>(resolve(name));
}

template <typename Pointer>
void load(const Resolver& resolve, Pointer& function, const char* name) {
    load_optional(resolve, function, name);
    if (function == nullptr) {
        throw RenderError(fmt::format("the OpenGL driver lacks {}, which OpenGL 4.5 must have", name));
    }
}

}  // namespace

Functions load_functions(const Resolver& resolve) {
    Functions gl;
#define SHEER_GL_FUNCTION(type, name) load(resolve, gl.name, "gl" #name);
#define SHEER_GL_OPTIONAL(type, name) load_optional(resolve, gl.name, "gl" #name);
#include "renderer/gl/functions.def"
#undef SHEER_GL_FUNCTION
#undef SHEER_GL_OPTIONAL
    return gl;
}

}  // namespace sheer::gl
