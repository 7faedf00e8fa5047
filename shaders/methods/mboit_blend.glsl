// Set before: mboit_inputs.glsl, mboit_power.glsl or mboit_trigonometric.glsl, SHEER_MOMENTS.
layout(location = 0) out vec4 o_sum;             // blend ONE, ONE
layout(location = 1) out float o_transmittance;  // blend ZERO, ONE_MINUS_SRC_COLOR

float transmittance() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float total = texelFetch(u_absorbance, pixel, 0).r;
    vec4 moments_0 = texelFetch(u_moments_0, pixel, 0), moments_1 = vec4(0.0);
#if SHEER_MOMENTS > 4
    moments_1 = texelFetch(u_moments_1, pixel, 0);
#endif
    float moments[SHEER_MOMENTS + 1];
    moments[0] = 1.0;
    for (int i = 1; i <= SHEER_MOMENTS; ++i)
        moments[i] = mix((i <= 4 ? moments_0[(i - 1) & 3] : moments_1[(i - 1) & 3]) / total, spread[i], u_bias);
    return clamp(exp(-total * before(moments, gl_FragCoord.z)), 0.0, 1.0);
}

void main() {
    begin_fragment();
    vec4 work = clamp(real_work(v_uv, v_tint), 0.0, 1.0);
    if (work.a == 0.0) discard;
    o_sum = transmittance() * vec4(work.rgb * work.a, work.a);
    o_transmittance = work.a;
}
