// A real_work that is the user's own. Set before: SHEER_TEXTURED, 0 or 1, and SHEER_ITERATIONS.

// A driver may leave an endless loop without a word. So the user's loops ask before each iteration whether they may, and
// a pass that is not timed finds the fragments that were refused (renderer/frame/loop_check.h).
int sheer_iterations_left = 0;  // under 0 once an iteration was refused

bool sheer_next() {
    --sheer_iterations_left;
    return sheer_iterations_left >= 0;
}

#if SHEER_TEXTURED
layout(binding = 0) uniform sampler2DArray u_textures;

// From derivatives, which mean nothing once neighbours have parted ways: worked out before any branch.
float sheer_level_of_detail;

vec4 sample_texture(int index, vec2 uv) {
    return textureLod(u_textures, vec3(uv, float(index & 3)), sheer_level_of_detail);
}
#endif

void begin_fragment() {
    sheer_iterations_left = SHEER_ITERATIONS;
#if SHEER_TEXTURED
    vec2 dx = dFdx(v_uv), dy = dFdy(v_uv);
    sheer_level_of_detail = 0.5 * log2(max(dot(dx, dx), dot(dy, dy))) + log2(float(textureSize(u_textures, 0).x));
#endif
}

// The user's function follows.
vec4 sheer_own_work(vec2 uv, vec4 tint);

// 1. As in real_work.glsl, only what stands in a loop is left out for discarded fragments on llvmpipe.
uniform int u_reads;

vec4 real_work(vec2 uv, vec4 tint) {
    vec4 work = vec4(0.0);
    for (int i = 0; i < u_reads; ++i) work = sheer_own_work(uv, tint);
    return work;
}

