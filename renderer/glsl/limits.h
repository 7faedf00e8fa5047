#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

namespace sheer {

/// How many numbers (floats, integers, booleans) one array may hold, and all arrays of a function together. Drivers
/// keep them in registers or on the stack, once for each fragment that is shaded at the same time.
inline constexpr std::int64_t max_array_numbers = 4096, max_array_numbers_together = 16384;

/// Tokens of one statement.
inline constexpr std::size_t max_statement_tokens = 8192;

/// Refuses code on which drivers crash instead of reporting an error. `text` is the body of a function, without
/// comments. Throws GlslError for statements that are too long, for arrays that are too large or of unknown size, and
/// for constant divisions without a result: by 0, and of the least integer by -1.
///
/// Returns the same text with guarded divisions: a / b becomes a * sheer_sign(b) / sheer_magnitude(b), which never
/// divides an integer by -1 (shaders/scenes/glsl_shading.glsl). Line numbers do not change.
std::string guard_glsl(const std::string& text);

}  // namespace sheer
