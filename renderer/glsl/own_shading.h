#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "renderer/core/errors.h"
#include "renderer/glsl/tokens.h"

namespace sheer {

inline constexpr std::size_t max_glsl_bytes = 64 * 1024;

/// The limit for all loops of a fragment together. Below what drivers allow: llvmpipe silently leaves every loop of a
/// shader after 65,535 iterations of eight fragments that run in step.
inline constexpr int iterations_per_fragment = 4096;

/// The user's own shading, from which shaders/scenes/glsl_shading.glsl makes a real_work.
struct GlslShading {
    std::string function;      ///< GLSL of `vec4 sheer_own_work(vec2 uv, vec4 tint)`
    bool has_loops = false;    ///< each of them calls sheer_next() before an iteration
    bool is_textured = false;  ///< it names sample_texture
    /// It calls a function whose result depends on the neighbours of a fragment.
    bool takes_derivatives = false;
};

/// Makes the function from its body: printable ASCII without directives, with matching brackets and within the limits
/// of renderer/glsl/limits.h. Throws GlslError.
GlslShading make_glsl_shading(const std::string& body);

/// Adds an error if the shading of a normalised scene is GLSL that make_glsl_shading refuses.
void check_glsl_shading(const nlohmann::json& scene, const std::string& pointer, std::vector<FieldError>& errors);

/// The errors in a driver's log that concern the user's function: "line 3: ...", one per line. "" if there are none.
/// Reads the logs of Mesa, NVIDIA and AMD.
std::string user_messages(const std::string& driver_log);

}  // namespace sheer
