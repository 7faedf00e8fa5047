// The paper's section 2.2, in its two forms: if/else, which it found faster on some hardware, and if/discard.
// Set before: SHEER_FRAMEBUFFER_FETCH, SHEER_SEPARATE_ALPHA, SHEER_IF_ELSE and SHEER_INVERTED, 0 or 1.

uniform float u_threshold;

#if SHEER_FRAMEBUFFER_FETCH
layout(location = 0) inout vec4 o_color;  // blend DST_ALPHA, ONE; alpha ZERO, SRC_ALPHA; see AlphaForm for the others
#else
layout(location = 0) out vec4 o_color;  // the same
uniform sampler2D u_alpha;
#endif

#if SHEER_SEPARATE_ALPHA
#if SHEER_FRAMEBUFFER_FETCH
layout(location = 1) inout vec4 o_alpha;  // blend ZERO, SRC_COLOR
#else
layout(location = 1) out vec4 o_alpha;  // blend ZERO, SRC_COLOR
#endif
#endif

float kept_alpha() {
#if SHEER_FRAMEBUFFER_FETCH && SHEER_SEPARATE_ALPHA
    return o_alpha.r;
#elif SHEER_FRAMEBUFFER_FETCH
    return o_color.a;
#elif SHEER_SEPARATE_ALPHA
    return texelFetch(u_alpha, ivec2(gl_FragCoord.xy), 0).r;
#else
    return texelFetch(u_alpha, ivec2(gl_FragCoord.xy), 0).a;
#endif
}

bool is_saturated() {
    return (SHEER_INVERTED != 0 ? kept_alpha() : 1.0 - kept_alpha()) < u_threshold;
}

void shade() {
    vec4 work = clamp(real_work(v_uv, v_tint), 0.0, 1.0);
    float alpha = SHEER_INVERTED != 0 ? 1.0 - work.a : work.a;
    o_color = vec4(work.rgb * work.a, alpha);
#if SHEER_SEPARATE_ALPHA
    o_alpha = vec4(alpha);
#endif
}

void main() {
    begin_fragment();
#if SHEER_IF_ELSE
    if (is_saturated()) {
        discard;
    } else {
        shade();
    }
#else
    if (is_saturated()) discard;
    shade();
#endif
}
