#pragma once
#include <string>

#include "renderer/gl/functions.h"

namespace sheer::gl {

struct UniformPlace {
    GLuint program;
    GLint location;
};

/// Copies one uniform, or one element of an array of them, from one program to another. `type` is what
/// glGetActiveUniform returned; throws std::logic_error with `name` for a type that OpenGL 4.5 does not have.
void copy_uniform(const Functions& gl, const UniformPlace& from, const UniformPlace& to, const std::string& name,
                  GLenum type);

}  // namespace sheer::gl
