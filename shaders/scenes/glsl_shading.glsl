// The user's own real_work. Set before: SHEER_TEXTURED, 0 or 1, and SHEER_ITERATIONS.

// A driver may leave an endless loop silently. So the user's loops check before each iteration whether it is allowed,
// and a pass that is not timed finds the fragments that were refused one (renderer/counting/loop_check.h).
int sheer_iterations_left = 0;  // negative once an iteration was refused

#ifdef SHEER_REPORT_LOOPS
// Set when a method is drawn once to check whether all of its fragments, at its own samples, end their loops.
layout(std430, binding = SHEER_REPORT_LOOPS) buffer SheerRefused { uint sheer_any_refused; };
#endif

bool sheer_next() {
    --sheer_iterations_left;
#ifdef SHEER_REPORT_LOOPS
    if (sheer_iterations_left < 0) sheer_any_refused = 1u;
#endif
    return sheer_iterations_left >= 0;
}

#if SHEER_TEXTURED
layout(binding = 0) uniform sampler2DArray u_textures;

// From derivatives, which are undefined once neighbours have diverged: computed before any branch.
float sheer_level_of_detail;

vec4 sample_texture(int index, vec2 uv) {
    return textureLod(u_textures, vec3(uv, float(index & 3)), sheer_level_of_detail);
}
#endif

void begin_fragment() {
    sheer_iterations_left = SHEER_ITERATIONS;
#if SHEER_TEXTURED
    vec2 dx = SHEER_UV_DX, dy = SHEER_UV_DY;
    sheer_level_of_detail = 0.5 * log2(max(dot(dx, dx), dot(dy, dy))) + log2(float(textureSize(u_textures, 0).x));
#endif
}

// An integer division of the least number by -1 has no result, and some drivers crash on it. The user's a / b, whatever
// its type, is a * sheer_sign(b) / sheer_magnitude(b), which is the same and never divides an integer by -1.
#define SHEER_DIVISOR(T, ONE)                   \
    T sheer_magnitude(T by) { return by; }      \
    ONE sheer_sign(T by) { return ONE(1); }
#define SHEER_DIVISOR_OF_INTEGERS(T)                                                       \
    T sheer_magnitude(T by) { return mix(by, T(1), equal(by, T(-1))); }                    \
    T sheer_sign(T by) { return mix(T(1), T(-1), equal(by, T(-1))); }

int sheer_magnitude(int by) { return by == -1 ? 1 : by; }
int sheer_sign(int by) { return by == -1 ? -1 : 1; }
SHEER_DIVISOR_OF_INTEGERS(ivec2)
SHEER_DIVISOR_OF_INTEGERS(ivec3)
SHEER_DIVISOR_OF_INTEGERS(ivec4)
SHEER_DIVISOR(uint, uint)
SHEER_DIVISOR(uvec2, uint)
SHEER_DIVISOR(uvec3, uint)
SHEER_DIVISOR(uvec4, uint)
SHEER_DIVISOR(float, float)
SHEER_DIVISOR(vec2, float)
SHEER_DIVISOR(vec3, float)
SHEER_DIVISOR(vec4, float)
SHEER_DIVISOR(mat2, float)
SHEER_DIVISOR(mat3, float)
SHEER_DIVISOR(mat4, float)
SHEER_DIVISOR(mat2x3, float)
SHEER_DIVISOR(mat2x4, float)
SHEER_DIVISOR(mat3x2, float)
SHEER_DIVISOR(mat3x4, float)
SHEER_DIVISOR(mat4x2, float)
SHEER_DIVISOR(mat4x3, float)
SHEER_DIVISOR(double, double)
SHEER_DIVISOR(dvec2, double)
SHEER_DIVISOR(dvec3, double)
SHEER_DIVISOR(dvec4, double)
