// Follows the scene's shading in every program. Where COUNT_SHADED is set, each call of real_work adds 1 to the pixel;
// its value is what main() must begin with: layout(early_fragment_tests) in; or nothing. See
// renderer/frame/shading_counter.h.
#ifdef COUNT_SHADED
COUNT_SHADED

layout(binding = 0, r32ui) uniform restrict uimage2D u_shaded;

// Pixels of that image for each of the picture that is drawn, which may be a smaller one.
uniform vec2 u_shaded_scale;

vec4 counted_real_work(vec2 uv, vec4 tint) {
    imageAtomicAdd(u_shaded, ivec2(gl_FragCoord.xy * u_shaded_scale), 1u);
    return real_work(uv, tint);
}

#define real_work counted_real_work
#endif
