layout(location = 0) out float o_count;  // blend ONE, ONE

void main() {
    begin_fragment();
    o_count = real_work(v_uv, v_tint).a > 0.0 ? 1.0 : 0.0;
}
