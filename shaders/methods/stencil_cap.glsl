// Set before: ALPHA_TEST, 0 or 1. Without it early fragment tests are on; with it a dropped fragment must not count in
// the stencil.
uniform float u_min_alpha;

layout(location = 0) out vec4 o_color;  // blend DST_ALPHA, ONE; alpha ZERO, SRC_ALPHA

void main() {
    begin_fragment();
    vec4 work = clamp(real_work(v_uv, v_tint), 0.0, 1.0);
#if ALPHA_TEST
    if (work.a < u_min_alpha) discard;
#endif
    o_color = vec4(work.rgb * work.a, 1.0 - work.a);
}
