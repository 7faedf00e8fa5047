#pragma once
#include <string_view>

namespace sheer {

/// A shading that every scene may have: how many textures a fragment reads, in turn, and whether the sampled positions
/// are bent. (shaders/scenes/real_work.glsl.)
struct Shading {
    std::string_view name;  ///< in a spec
    int reads;
    bool math;
};

namespace shadings {

inline constexpr Shading constant{"constant", 0, false};
inline constexpr Shading one_texture{"1-texture", 1, false};
inline constexpr Shading four_textures{"4-textures", 4, false};
inline constexpr Shading four_textures_math{"4-textures-math", 4, true};
inline constexpr Shading sixteen_textures{"4x4-textures", 16, false};
inline constexpr Shading sixteen_textures_math{"4x4-textures-math", 16, true};

inline constexpr Shading all[] = {constant,           one_texture,      four_textures,
                                  four_textures_math, sixteen_textures, sixteen_textures_math};

}  // namespace shadings

}  // namespace sheer
