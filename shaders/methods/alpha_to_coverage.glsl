uniform float u_least_alpha;

// No blending, alpha not written; it decides which samples are covered. Depth test and depth writes.
layout(location = 0) out vec4 o_color;

void main() {
    begin_fragment();
    vec4 work = clamp(real_work(v_uv, v_tint), 0.0, 1.0);
    if (work.a < u_least_alpha) discard;
    o_color = work;
}
