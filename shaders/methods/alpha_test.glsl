uniform float u_least_alpha;

layout(location = 0) out vec4 o_color;  // no blending; depth test and depth writes

void main() {
    begin_fragment();
    vec4 work = clamp(real_work(v_uv, v_tint), 0.0, 1.0);
    if (work.a < u_least_alpha) discard;
    o_color = vec4(work.rgb, 1.0);
}
