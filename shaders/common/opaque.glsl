layout(location = 0) out vec4 o_color;  // no blending

void main() {
    begin_fragment();
    bool untextured = v_uv.x < 0.0;
    vec4 work = v_tint;
    if (!untextured) work = real_work(v_uv, v_tint);
    o_color = vec4(clamp(work.rgb, 0.0, 1.0), 1.0);
}
