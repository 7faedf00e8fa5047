layout(location = 0) out vec4 o_color;  // blend SRC_ALPHA, ONE_MINUS_SRC_ALPHA; alpha ONE, ONE_MINUS_SRC_ALPHA

void main() {
    begin_fragment();
    o_color = clamp(real_work(v_uv, v_tint), 0.0, 1.0) * vec4(1.0, 1.0, 1.0, 0.5);
}
