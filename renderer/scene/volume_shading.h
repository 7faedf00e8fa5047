#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "renderer/gl/objects.h"
#include "renderer/scene/volume.h"

namespace sheer {

/// What the shading "transfer-function" reads (shaders/scenes/transfer-function.glsl).
struct VolumeShading {
    Volume volume;
    glm::mat4 to_texture{1};  ///< from the scene's space, in which the camera is at the origin: 0..1 over the box
    glm::vec2 value{1, 0};    ///< a value is what the texture gives times x, plus y
    std::vector<glm::vec4> transfer;  ///< straight color and alpha of a slice for the values 0..1, evenly spread
    bool light = true;
    glm::vec3 to_sun{0, 0, 1};  ///< of length 1, in the scene's space
};

/// Opacity of a path through a medium in which a path of length 1 has the opacity `alpha` (0..1):
/// 1 - (1 - alpha)^length.
double opacity_of(double alpha, double length);

/// A VolumeShading on the device.
class VolumeTextures {
  public:
    VolumeTextures() = default;
    VolumeTextures(const gl::Functions& gl, const VolumeShading& shading);

    /// Does nothing for an empty one. `program` is in use.
    void bind(const gl::Functions& gl, const gl::Program& program) const;

  private:
    gl::Texture m_volume, m_transfer;
    glm::mat4 m_to_texture{1};
    glm::vec2 m_value{1, 0};
    bool m_light = false;
    glm::vec3 m_to_sun{0};
};

}  // namespace sheer
