layout(location = 0) out vec4 o_sums;    // blend ONE, ONE
layout(location = 1) out float o_count;  // blend ONE, ONE

void main() {
    begin_fragment();
    vec4 work = clamp(real_work(v_uv, v_tint), 0.0, 1.0);
    if (work.a == 0.0) discard;
    o_sums = vec4(work.rgb * work.a, work.a);
    o_count = 1.0;
}
