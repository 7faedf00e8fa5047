layout(early_fragment_tests) in;

// Each slot keeps the least key that it is offered and passes the other one on, so the order of the fragments does not
// matter. No color output: the color mask is off.
void main() {
    begin_fragment();
    float alpha = clamp(real_work(v_uv, v_tint).a, 0.0, 1.0);
    if (alpha == 0.0) return;
    uint key = depth_part(gl_FragCoord.z) << 8 | uint((1.0 - alpha) * 255.0 + 0.5), first = first_key();
    for (uint i = 0u; i < uint(SHEER_K) && key != no_key; ++i) key = max(key, atomicMin(keys[first + i], key));
}
