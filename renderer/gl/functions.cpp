#include "renderer/gl/functions.h"

#include <fmt/format.h>

#include "renderer/core/errors.h"
#include "used_gl_functions.h"

namespace sheer::gl {

Functions load_functions(const Resolver& resolve) {
    for (const char* name : used_functions) {
        if (resolve(name) == nullptr) {
            throw RenderError(fmt::format("the OpenGL driver lacks {}, which OpenGL 4.5 must have", name));
        }
    }
    const auto load = [](void* user, const char* name) {
        return reinterpret_cast<GLADapiproc>((*static_cast<const Resolver*>(user))(name));
    };
    Functions gl{};
    gladLoadGLContextUserPtr(&gl, load, const_cast<Resolver*>(&resolve));
    // glad only loads the functions of the versions up to the one that it reads in GL_VERSION.
    if (gl.VERSION_4_5 == 0) throw RenderError("the OpenGL driver's GL_VERSION does not begin with 4.5 or more");
    return gl;
}

}  // namespace sheer::gl
