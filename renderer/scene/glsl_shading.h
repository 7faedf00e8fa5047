#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "renderer/errors.h"
#include "renderer/scene/glsl_tokens.h"

namespace sheer {

/// Where a spec has a shading of the user's own.
inline constexpr const char* glsl_shading_pointer = "/scene/shading/glsl";

inline constexpr std::size_t max_glsl_bytes = 64 * 1024;

/// What all loops of a fragment may take together. Under what drivers allow: llvmpipe leaves every loop of a shader,
/// without a word, after 65,535 iterations of eight fragments that run in step.
inline constexpr int iterations_per_fragment = 4096;

/// The user's own shading, which shaders/scenes/glsl_shading.glsl makes a real_work of.
struct GlslShading {
    std::string function;      ///< GLSL of `vec4 sheer_own_work(vec2 uv, vec4 tint)`
    bool has_loops = false;    ///< each of them asks sheer_next() before an iteration
    bool is_textured = false;  ///< it names sample_texture
};

/// Makes the function from its body: printable ASCII without directives, brackets in pairs, and within the
/// limits of renderer/scene/glsl_limits.h. Throws GlslError.
GlslShading make_glsl_shading(const std::string& body);

/// Adds the error of a normalised scene whose shading is GLSL that make_glsl_shading refuses.
void check_glsl_shading(const nlohmann::json& scene, const std::string& pointer, std::vector<FieldError>& errors);

/// The errors in a driver's log that are about the user's function: "line 3: ...", a line each. "" if there are none.
/// Reads the logs of Mesa, NVIDIA and AMD.
std::string user_messages(const std::string& driver_log);

}  // namespace sheer
