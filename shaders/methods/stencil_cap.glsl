// Set before: SHEER_ALPHA_TEST and SHEER_HAS_OPAQUE, 0 or 1. Without an alpha test early fragment tests are on; with
// it a dropped fragment must not count in the stencil. There a fragment that the cap stops counts as hidden by it (the
// stencil test comes before the depth test), so one that opaque geometry hides must be dropped here.
uniform float u_least_alpha;

#if SHEER_ALPHA_TEST && SHEER_HAS_OPAQUE
uniform sampler2D u_opaque_depth;
#endif

layout(location = 0) out vec4 o_color;  // blend DST_ALPHA, ONE; alpha ZERO, SRC_ALPHA

void main() {
    begin_fragment();
#if SHEER_ALPHA_TEST && SHEER_HAS_OPAQUE
    if (gl_FragCoord.z > texelFetch(u_opaque_depth, ivec2(gl_FragCoord.xy), 0).r) discard;
#endif
    vec4 work = clamp(real_work(v_uv, v_tint), 0.0, 1.0);
#if SHEER_ALPHA_TEST
    if (work.a < u_least_alpha) discard;
#endif
    o_color = vec4(work.rgb * work.a, 1.0 - work.a);
}
