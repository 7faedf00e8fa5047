#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

namespace sheer {

/// Numbers (floats, integers, booleans) that one array may hold, and all arrays of a function together. Drivers keep
/// them in registers or on the stack, once for each fragment that is shaded at the same time.
inline constexpr std::int64_t max_array_numbers = 4096, max_array_numbers_together = 16384;

/// Words, numbers and signs of one statement.
inline constexpr std::size_t max_statement_tokens = 8192;

/// Refuses what drivers die of rather than report. `text` is the body of a function, without comments.
/// Throws GlslError for statements that are too long, for arrays that are too large or whose size cannot be told, and
/// for divisions of constants that have no result: by 0, and of the least integer by -1.
///
/// Returns the same text with its divisions guarded: a / b becomes a * sheer_sign(b) / sheer_magnitude(b), which of
/// integers leaves no division by -1 (shaders/scenes/glsl_shading.glsl). Lines stay where they are.
std::string guard_glsl(const std::string& text);

}  // namespace sheer
