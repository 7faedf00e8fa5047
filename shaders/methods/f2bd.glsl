// The paper's section 2.2, in the if/else form that it found faster on some hardware.
// Set before: FRAMEBUFFER_FETCH and SEPARATE_ALPHA, 0 or 1.

uniform float u_threshold;

#if FRAMEBUFFER_FETCH
layout(location = 0) inout vec4 o_color;  // blend DST_ALPHA, ONE; alpha ZERO, SRC_ALPHA
#else
layout(location = 0) out vec4 o_color;  // blend DST_ALPHA, ONE; alpha ZERO, SRC_ALPHA
layout(binding = 8) uniform sampler2D u_alpha;
#endif

#if SEPARATE_ALPHA
#if FRAMEBUFFER_FETCH
layout(location = 1) inout vec4 o_alpha;  // blend ZERO, SRC_COLOR
#else
layout(location = 1) out vec4 o_alpha;  // blend ZERO, SRC_COLOR
#endif
#endif

float transmittance() {
#if FRAMEBUFFER_FETCH && SEPARATE_ALPHA
    return o_alpha.r;
#elif FRAMEBUFFER_FETCH
    return o_color.a;
#elif SEPARATE_ALPHA
    return texelFetch(u_alpha, ivec2(gl_FragCoord.xy), 0).r;
#else
    return texelFetch(u_alpha, ivec2(gl_FragCoord.xy), 0).a;
#endif
}

void main() {
    begin_fragment();
    if (transmittance() < u_threshold) {
        discard;
    } else {
        vec4 work = clamp(real_work(v_uv, v_tint), 0.0, 1.0);
        o_color = vec4(work.rgb * work.a, 1.0 - work.a);
#if SEPARATE_ALPHA
        o_alpha = vec4(1.0 - work.a);
#endif
    }
}
