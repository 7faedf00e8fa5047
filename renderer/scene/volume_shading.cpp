#include "renderer/scene/volume_shading.h"

#include <cmath>

namespace sheer {

namespace {

constexpr GLuint volume_unit = 1, transfer_unit = 2;

void set_filter(const gl::Functions& gl, GLuint texture) {
    gl.TextureParameteri(texture, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl.TextureParameteri(texture, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
        gl.TextureParameteri(texture, axis, GL_CLAMP_TO_EDGE);
}

gl::Texture make_texture_3d(const gl::Functions& gl, const Volume& volume) {
    GLuint id = 0;
    gl.CreateTextures(GL_TEXTURE_3D, 1, &id);
    gl::Texture texture(gl, id, "volume");
    set_filter(gl, id);
    const bool eight_bit = volume.floats.empty();
    const void* voxels = eight_bit ? static_cast<const void*>(volume.bytes.data()) : volume.floats.data();
    gl.TextureStorage3D(id, 1, eight_bit ? GL_R8 : GL_R32F, volume.size.x, volume.size.y, volume.size.z);
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl.TextureSubImage3D(id, 0, 0, 0, 0, volume.size.x, volume.size.y, volume.size.z, GL_RED,
                         eight_bit ? GL_UNSIGNED_BYTE : GL_FLOAT, voxels);
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    return texture;
}

}  // namespace

double opacity_of(double alpha, double length) {
    return 1 - std::pow(1 - alpha, length);
}

VolumeTextures::VolumeTextures(const gl::Functions& gl, const VolumeShading& shading)
    : m_volume(make_texture_3d(gl, shading.volume)),
      m_to_texture(shading.to_texture),
      m_value(shading.value),
      m_light(shading.light),
      m_to_sun(shading.to_sun) {
    const auto width = static_cast<int>(shading.transfer.size());
    m_transfer = gl::make_texture_2d(gl, "transfer function", GL_RGBA32F, width, 1);
    set_filter(gl, m_transfer.id());
    gl.TextureSubImage2D(m_transfer.id(), 0, 0, 0, width, 1, GL_RGBA, GL_FLOAT, shading.transfer.data());
}

void VolumeTextures::bind(const gl::Functions& gl, const gl::Program& program) const {
    if (!m_volume) return;
    gl.BindTextureUnit(volume_unit, m_volume.id());
    gl.BindTextureUnit(transfer_unit, m_transfer.id());
    program.set("u_to_texture", m_to_texture);
    program.set("u_value", m_value);
    program.set("u_light", m_light ? 1 : 0);
    program.set("u_to_sun", m_to_sun);
}

}  // namespace sheer
