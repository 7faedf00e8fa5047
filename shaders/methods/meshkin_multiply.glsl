// Slide 31, of which only the product of the alphas is needed.

layout(location = 0) out float o_product;  // blend ZERO, SRC_COLOR

void main() {
    begin_fragment();
    float alpha = clamp(real_work(v_uv, v_tint).a, 0.0, 1.0);
    if (alpha == 0.0) discard;
    o_product = alpha;
}
