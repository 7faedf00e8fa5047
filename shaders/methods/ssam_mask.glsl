// Listing 3.1.

layout(location = 0) out vec4 o_mask;  // blend MAX for color; ADD with ONE, ONE for alpha

void main() {
    begin_fragment();
    o_mask = vec4(clamp(real_work(v_uv, v_tint).a, 0.0, 1.0));
}
