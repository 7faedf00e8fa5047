#include "renderer/gl/copy_uniform.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <stdexcept>

namespace sheer::gl {
namespace {

/// How the values of one type of uniform are written; `Write` is one of glProgramUniform*v.
template <typename Write>
struct UniformType {
    GLenum type;
    Write Functions::*write;
};

constexpr UniformType<PFNGLPROGRAMUNIFORM1FVPROC> float_types[] = {{GL_FLOAT, &Functions::ProgramUniform1fv},
                                                                   {GL_FLOAT_VEC2, &Functions::ProgramUniform2fv},
                                                                   {GL_FLOAT_VEC3, &Functions::ProgramUniform3fv},
                                                                   {GL_FLOAT_VEC4, &Functions::ProgramUniform4fv}};
constexpr UniformType<PFNGLPROGRAMUNIFORM1DVPROC> double_types[] = {{GL_DOUBLE, &Functions::ProgramUniform1dv},
                                                                    {GL_DOUBLE_VEC2, &Functions::ProgramUniform2dv},
                                                                    {GL_DOUBLE_VEC3, &Functions::ProgramUniform3dv},
                                                                    {GL_DOUBLE_VEC4, &Functions::ProgramUniform4dv}};
constexpr UniformType<PFNGLPROGRAMUNIFORM1IVPROC> int_types[] = {
    {GL_INT, &Functions::ProgramUniform1iv},      {GL_BOOL, &Functions::ProgramUniform1iv},
    {GL_INT_VEC2, &Functions::ProgramUniform2iv}, {GL_BOOL_VEC2, &Functions::ProgramUniform2iv},
    {GL_INT_VEC3, &Functions::ProgramUniform3iv}, {GL_BOOL_VEC3, &Functions::ProgramUniform3iv},
    {GL_INT_VEC4, &Functions::ProgramUniform4iv}, {GL_BOOL_VEC4, &Functions::ProgramUniform4iv}};
constexpr UniformType<PFNGLPROGRAMUNIFORM1UIVPROC> uint_types[] = {
    {GL_UNSIGNED_INT, &Functions::ProgramUniform1uiv},
    {GL_UNSIGNED_INT_VEC2, &Functions::ProgramUniform2uiv},
    {GL_UNSIGNED_INT_VEC3, &Functions::ProgramUniform3uiv},
    {GL_UNSIGNED_INT_VEC4, &Functions::ProgramUniform4uiv}};
constexpr UniformType<PFNGLPROGRAMUNIFORMMATRIX2FVPROC> float_matrix_types[] = {
    {GL_FLOAT_MAT2, &Functions::ProgramUniformMatrix2fv},     {GL_FLOAT_MAT3, &Functions::ProgramUniformMatrix3fv},
    {GL_FLOAT_MAT4, &Functions::ProgramUniformMatrix4fv},     {GL_FLOAT_MAT2x3, &Functions::ProgramUniformMatrix2x3fv},
    {GL_FLOAT_MAT2x4, &Functions::ProgramUniformMatrix2x4fv}, {GL_FLOAT_MAT3x2, &Functions::ProgramUniformMatrix3x2fv},
    {GL_FLOAT_MAT3x4, &Functions::ProgramUniformMatrix3x4fv}, {GL_FLOAT_MAT4x2, &Functions::ProgramUniformMatrix4x2fv},
    {GL_FLOAT_MAT4x3, &Functions::ProgramUniformMatrix4x3fv}};
constexpr UniformType<PFNGLPROGRAMUNIFORMMATRIX2DVPROC> double_matrix_types[] = {
    {GL_DOUBLE_MAT2, &Functions::ProgramUniformMatrix2dv},
    {GL_DOUBLE_MAT3, &Functions::ProgramUniformMatrix3dv},
    {GL_DOUBLE_MAT4, &Functions::ProgramUniformMatrix4dv},
    {GL_DOUBLE_MAT2x3, &Functions::ProgramUniformMatrix2x3dv},
    {GL_DOUBLE_MAT2x4, &Functions::ProgramUniformMatrix2x4dv},
    {GL_DOUBLE_MAT3x2, &Functions::ProgramUniformMatrix3x2dv},
    {GL_DOUBLE_MAT3x4, &Functions::ProgramUniformMatrix3x4dv},
    {GL_DOUBLE_MAT4x2, &Functions::ProgramUniformMatrix4x2dv},
    {GL_DOUBLE_MAT4x3, &Functions::ProgramUniformMatrix4x3dv}};

template <std::size_t count, typename Write>
Write find_write(const Functions& gl, const UniformType<Write> (&types)[count], GLenum type) {
    const auto* found = std::ranges::find(types, type, &UniformType<Write>::type);
    return found == std::end(types) ? nullptr : gl.*(found->write);
}

/// Samplers and images, which hold the number of a unit.
constexpr GLenum unit_types[] = {GL_SAMPLER_1D,
                                 GL_SAMPLER_2D,
                                 GL_SAMPLER_3D,
                                 GL_SAMPLER_CUBE,
                                 GL_SAMPLER_2D_RECT,
                                 GL_SAMPLER_1D_ARRAY,
                                 GL_SAMPLER_2D_ARRAY,
                                 GL_SAMPLER_CUBE_MAP_ARRAY,
                                 GL_SAMPLER_BUFFER,
                                 GL_SAMPLER_2D_MULTISAMPLE,
                                 GL_SAMPLER_2D_MULTISAMPLE_ARRAY,
                                 GL_INT_SAMPLER_1D,
                                 GL_INT_SAMPLER_2D,
                                 GL_INT_SAMPLER_3D,
                                 GL_INT_SAMPLER_CUBE,
                                 GL_INT_SAMPLER_2D_RECT,
                                 GL_INT_SAMPLER_1D_ARRAY,
                                 GL_INT_SAMPLER_2D_ARRAY,
                                 GL_INT_SAMPLER_CUBE_MAP_ARRAY,
                                 GL_INT_SAMPLER_BUFFER,
                                 GL_INT_SAMPLER_2D_MULTISAMPLE,
                                 GL_INT_SAMPLER_2D_MULTISAMPLE_ARRAY,
                                 GL_UNSIGNED_INT_SAMPLER_1D,
                                 GL_UNSIGNED_INT_SAMPLER_2D,
                                 GL_UNSIGNED_INT_SAMPLER_3D,
                                 GL_UNSIGNED_INT_SAMPLER_CUBE,
                                 GL_UNSIGNED_INT_SAMPLER_2D_RECT,
                                 GL_UNSIGNED_INT_SAMPLER_1D_ARRAY,
                                 GL_UNSIGNED_INT_SAMPLER_2D_ARRAY,
                                 GL_UNSIGNED_INT_SAMPLER_CUBE_MAP_ARRAY,
                                 GL_UNSIGNED_INT_SAMPLER_BUFFER,
                                 GL_UNSIGNED_INT_SAMPLER_2D_MULTISAMPLE,
                                 GL_UNSIGNED_INT_SAMPLER_2D_MULTISAMPLE_ARRAY,
                                 GL_SAMPLER_1D_SHADOW,
                                 GL_SAMPLER_2D_SHADOW,
                                 GL_SAMPLER_CUBE_SHADOW,
                                 GL_SAMPLER_2D_RECT_SHADOW,
                                 GL_SAMPLER_1D_ARRAY_SHADOW,
                                 GL_SAMPLER_2D_ARRAY_SHADOW,
                                 GL_SAMPLER_CUBE_MAP_ARRAY_SHADOW,
                                 GL_IMAGE_1D,
                                 GL_IMAGE_2D,
                                 GL_IMAGE_3D,
                                 GL_IMAGE_CUBE,
                                 GL_IMAGE_2D_RECT,
                                 GL_IMAGE_1D_ARRAY,
                                 GL_IMAGE_2D_ARRAY,
                                 GL_IMAGE_CUBE_MAP_ARRAY,
                                 GL_IMAGE_BUFFER,
                                 GL_IMAGE_2D_MULTISAMPLE,
                                 GL_IMAGE_2D_MULTISAMPLE_ARRAY,
                                 GL_INT_IMAGE_1D,
                                 GL_INT_IMAGE_2D,
                                 GL_INT_IMAGE_3D,
                                 GL_INT_IMAGE_CUBE,
                                 GL_INT_IMAGE_2D_RECT,
                                 GL_INT_IMAGE_1D_ARRAY,
                                 GL_INT_IMAGE_2D_ARRAY,
                                 GL_INT_IMAGE_CUBE_MAP_ARRAY,
                                 GL_INT_IMAGE_BUFFER,
                                 GL_INT_IMAGE_2D_MULTISAMPLE,
                                 GL_INT_IMAGE_2D_MULTISAMPLE_ARRAY,
                                 GL_UNSIGNED_INT_IMAGE_1D,
                                 GL_UNSIGNED_INT_IMAGE_2D,
                                 GL_UNSIGNED_INT_IMAGE_3D,
                                 GL_UNSIGNED_INT_IMAGE_CUBE,
                                 GL_UNSIGNED_INT_IMAGE_2D_RECT,
                                 GL_UNSIGNED_INT_IMAGE_1D_ARRAY,
                                 GL_UNSIGNED_INT_IMAGE_2D_ARRAY,
                                 GL_UNSIGNED_INT_IMAGE_CUBE_MAP_ARRAY,
                                 GL_UNSIGNED_INT_IMAGE_BUFFER,
                                 GL_UNSIGNED_INT_IMAGE_2D_MULTISAMPLE,
                                 GL_UNSIGNED_INT_IMAGE_2D_MULTISAMPLE_ARRAY};

}  // namespace

void copy_uniform(const Functions& gl, const UniformPlace& from, const UniformPlace& to, const std::string& name,
                  GLenum type) {
    std::array<GLfloat, 16> floats{};
    std::array<GLdouble, 16> doubles{};
    std::array<GLint, 4> ints{};
    std::array<GLuint, 4> uints{};
    if (const auto write_float = find_write(gl, float_types, type)) {
        gl.GetUniformfv(from.program, from.location, floats.data());
        write_float(to.program, to.location, 1, floats.data());
    } else if (const auto write_matrix = find_write(gl, float_matrix_types, type)) {
        gl.GetUniformfv(from.program, from.location, floats.data());
        write_matrix(to.program, to.location, 1, GL_FALSE, floats.data());
    } else if (const auto write_int = find_write(gl, int_types, type)) {
        gl.GetUniformiv(from.program, from.location, ints.data());
        write_int(to.program, to.location, 1, ints.data());
    } else if (const auto write_uint = find_write(gl, uint_types, type)) {
        gl.GetUniformuiv(from.program, from.location, uints.data());
        write_uint(to.program, to.location, 1, uints.data());
    } else if (const auto write_double = find_write(gl, double_types, type)) {
        gl.GetUniformdv(from.program, from.location, doubles.data());
        write_double(to.program, to.location, 1, doubles.data());
    } else if (const auto write_double_matrix = find_write(gl, double_matrix_types, type)) {
        gl.GetUniformdv(from.program, from.location, doubles.data());
        write_double_matrix(to.program, to.location, 1, GL_FALSE, doubles.data());
    } else if (std::ranges::find(unit_types, type) != std::end(unit_types)) {
        gl.GetUniformiv(from.program, from.location, ints.data());
        gl.ProgramUniform1i(to.program, to.location, ints[0]);
    } else {
        throw std::logic_error(fmt::format("the uniform {} has type {:#06x}, which is not copied", name, type));
    }
}

}  // namespace sheer::gl
