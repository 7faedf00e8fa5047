// Muenstermann et al. 2018, section 3.1. Set before: SHEER_MOMENTS, 4, 6 or 8; SHEER_TRIGONOMETRIC, 0 or 1, and if it is 1
// mboit_circle.glsl.
uniform float u_greatest_absorbance;

layout(location = 0) out float o_absorbance;  // all blend ONE, ONE
layout(location = 1) out vec4 o_moments_0;    // of the powers 1 to 4, or of cos and sin of one and two angles
#if SHEER_MOMENTS > 4
layout(location = 2) out vec4 o_moments_1;  // 5 to 8, or of three and four angles
#endif

void main() {
    begin_fragment();
    float alpha = clamp(real_work(v_uv, v_tint).a, 0.0, 1.0);
    if (alpha == 0.0) discard;
    float absorbance = min(-log(max(1.0 - alpha, 1e-30)), u_greatest_absorbance);
#if SHEER_TRIGONOMETRIC
    vec2 once = on_circle(angle_of(gl_FragCoord.z)), twice = times(once, once);
    vec4 first = vec4(once, twice), second = vec4(times(once, twice), times(twice, twice));
#else
    float z = 2.0 * gl_FragCoord.z - 1.0, z2 = z * z;
    vec4 first = vec4(z, z2, z * z2, z2 * z2);
    vec4 second = z2 * z2 * first;
#endif
    o_absorbance = absorbance;
    o_moments_0 = absorbance * first;
#if SHEER_MOMENTS > 4
    o_moments_1 = absorbance * second;
#endif
}
