layout(location = 0) out vec4 o_color;  // no blending

void main() {
    begin_fragment();
    o_color = vec4(clamp(real_work(v_uv, v_tint).rgb, 0.0, 1.0), 1.0);
}
