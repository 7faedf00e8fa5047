layout(location = 0) out float o_alpha;  // blend ZERO, ONE_MINUS_SRC_COLOR

void main() {
    begin_fragment();
    o_alpha = clamp(real_work(v_uv, v_tint).a, 0.0, 1.0);
}
