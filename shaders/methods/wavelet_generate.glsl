// Set before: wavelet_basis.glsl, SHEER_TARGETS, a quarter of the coefficients, rounded up.
uniform float u_greatest_absorbance;

layout(location = 0) out vec4 o_coefficients[SHEER_TARGETS];  // blend ONE, ONE

// The scalar product of a basis function and the step from 0 to 1 at `depth`.
float coefficient(int number, float depth) {
    if (number == 0) return 1.0 - depth;
    int level = findMSB(uint(number));
    float width = exp2(-float(level)), begin = float(number - (1 << level)) * width;
    return -exp2(0.5 * float(level)) * max(0.0, min(depth - begin, begin + width - depth));
}

void main() {
    begin_fragment();
    float alpha = clamp(real_work(v_uv, v_tint).a, 0.0, 1.0);
    if (alpha == 0.0) discard;
    float absorbance = min(-log(max(1.0 - alpha, 1e-30)), u_greatest_absorbance), depth = scaled_depth();
    for (int i = 0; i < SHEER_TARGETS; ++i)
        for (int k = 0; k < 4; ++k) o_coefficients[i][k] = absorbance * coefficient(4 * i + k, depth);
}
