// Set before: SHEER_EQUATION, 7 to 10 for the paper's weight of this number, or 0 for equal weights.
uniform float u_least_weight, u_greatest_weight, u_depth_scale, u_alpha_scale;

layout(location = 0) out vec4 o_sums;        // blend ONE, ONE
layout(location = 1) out float o_revealage;  // blend ZERO, ONE_MINUS_SRC_COLOR

float squared(float x) { return x * x; }
float cubed(float x) { return x * x * x; }

float weight(float alpha) {
#if SHEER_EQUATION == 0
    return 1.0;
#else
    float z = sheer_distance() * u_depth_scale;
#if SHEER_EQUATION == 7
    float of_depth = 10.0 / (1e-5 + squared(z / 5.0) + squared(cubed(z / 200.0)));
#elif SHEER_EQUATION == 8
    float of_depth = 10.0 / (1e-5 + cubed(z / 10.0) + squared(cubed(z / 200.0)));
#elif SHEER_EQUATION == 9
    float of_depth = 0.03 / (1e-5 + squared(squared(z / 200.0)));
#else
    float of_depth = 3e3 * cubed(1.0 - gl_FragCoord.z);
#endif
    return min(1.0, alpha * u_alpha_scale) * clamp(of_depth, u_least_weight, u_greatest_weight);
#endif
}

void main() {
    begin_fragment();
    vec4 work = clamp(real_work(v_uv, v_tint), 0.0, 1.0);
    if (work.a == 0.0) discard;
    o_sums = vec4(work.rgb * work.a, work.a) * weight(work.a);
    o_revealage = work.a;
}
