// Slide 29. Set before: SHEER_FULL, 0 or 1.

layout(location = 0) out vec4 o_sums;  // blend ONE, ONE
#if SHEER_FULL
layout(location = 1) out float o_reciprocals;  // blend ONE, ONE; 32 bits

const float largest = 3.0e38;  // an infinity would make the composite's product undefined
#endif

void main() {
    begin_fragment();
    vec4 work = clamp(real_work(v_uv, v_tint), 0.0, 1.0);
    if (work.a == 0.0) discard;
    o_sums = vec4(work.rgb * work.a, work.a);
#if SHEER_FULL
    o_reciprocals = min(1.0 / work.a, largest);
#endif
}
