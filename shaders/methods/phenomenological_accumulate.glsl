// McGuire and Mara 2017, transmission and coverage. The scene's alpha is the coverage; what is covered transmits
// u_transmission of its color.
uniform float u_transmission;

layout(location = 0) out vec4 o_sums;      // blend ONE, ONE
layout(location = 1) out vec4 o_modulation;  // blend ZERO, ONE_MINUS_SRC_COLOR

void main() {
    begin_fragment();
    vec4 work = clamp(real_work(v_uv, v_tint), 0.0, 1.0);
    if (work.a == 0.0) discard;
    vec3 transmitted = u_transmission * work.rgb, reflected = (1.0 - u_transmission) * work.rgb;
    float net_coverage = work.a * (1.0 - (transmitted.r + transmitted.g + transmitted.b) / 3.0);
    float root = (8.0 * net_coverage + 0.01) * (1.0 - 0.95 * gl_FragCoord.z);
    float weight = clamp(1e3 * root * root * root, 1e-2, 3e2);
    o_sums = weight * vec4(work.a * reflected, net_coverage);
    o_modulation = vec4(work.a * (1.0 - transmitted), 0.0);
}
