// Set before: SHEER_INVERTED, 1 (the default) or 0: alpha is 1 - opacity, or the opacity.
#ifndef SHEER_INVERTED
#define SHEER_INVERTED 1
#endif

layout(location = 0) out vec4 o_color;  // blend DST_ALPHA, ONE; alpha ZERO, SRC_ALPHA; see AlphaForm for the others

// The paper's section 2.2: clamp, premultiply, invert alpha.
void main() {
    begin_fragment();
    vec4 work = clamp(real_work(v_uv, v_tint), 0.0, 1.0);
    o_color = vec4(work.rgb * work.a, SHEER_INVERTED != 0 ? 1.0 - work.a : work.a);
}
