// Comes after the scene's shading in every program. If SHEER_COUNT_SHADED is set, each call of real_work adds 1 to the
// pixel; its value is layout(early_fragment_tests) in; or nothing. See renderer/counting/shading_counter.h.
#ifdef SHEER_COUNT_SHADED
SHEER_COUNT_SHADED

layout(binding = 0, r32ui) uniform restrict uimage2D u_shaded;

// Pixels of that image per pixel of the picture that is drawn, which may be smaller.
uniform vec2 u_shaded_scale;

vec4 counted_real_work(vec2 uv, vec4 tint) {
    imageAtomicAdd(u_shaded, ivec2(gl_FragCoord.xy * u_shaded_scale), 1u);
    return real_work(uv, tint);
}

#define real_work counted_real_work
#endif
