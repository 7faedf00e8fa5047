uniform float u_coverage;

layout(location = 0) out vec4 o_sum;           // blend ONE, ONE
layout(location = 1) out float o_transmittance;  // blend ZERO, ONE_MINUS_SRC_COLOR

void main() {
    begin_fragment();
    vec4 work = clamp(real_work(v_uv, v_tint), 0.0, 1.0);
    if (work.a == 0.0) discard;
    o_sum = vec4(work.rgb * work.a, work.a);
    o_transmittance = u_coverage * work.a;
}
