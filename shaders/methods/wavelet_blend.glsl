// Set before: wavelet_basis.glsl, SHEER_TARGETS.
uniform sampler2D u_coefficients_0;
#if SHEER_TARGETS > 1
uniform sampler2D u_coefficients_1;
#endif
#if SHEER_TARGETS > 2
uniform sampler2D u_coefficients_2, u_coefficients_3;
#endif
#if SHEER_TARGETS > 4
uniform sampler2D u_coefficients_4, u_coefficients_5, u_coefficients_6, u_coefficients_7;
#endif

layout(location = 0) out vec4 o_sum;             // blend ONE, ONE
layout(location = 1) out float o_transmittance;  // blend ZERO, ONE_MINUS_SRC_COLOR

vec4 four_of(int target) {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    switch (target) {
#if SHEER_TARGETS > 1
        case 1: return texelFetch(u_coefficients_1, pixel, 0);
#endif
#if SHEER_TARGETS > 2
        case 2: return texelFetch(u_coefficients_2, pixel, 0);
        case 3: return texelFetch(u_coefficients_3, pixel, 0);
#endif
#if SHEER_TARGETS > 4
        case 4: return texelFetch(u_coefficients_4, pixel, 0);
        case 5: return texelFetch(u_coefficients_5, pixel, 0);
        case 6: return texelFetch(u_coefficients_6, pixel, 0);
        case 7: return texelFetch(u_coefficients_7, pixel, 0);
#endif
        default: return texelFetch(u_coefficients_0, pixel, 0);
    }
}

float coefficient(int number) { return four_of(number / 4)[number % 4]; }

// The mean over a cell of the absorbance up to each depth.
float absorbance_in(int cell) {
    float sum = coefficient(0);
    for (int width = SHEER_COEFFICIENTS / 2, level = 0; width > 0; width /= 2, ++level) {
        int number = (1 << level) + cell / (2 * width);
        float scale = exp2(0.5 * float(level));
        sum += ((cell / width) % 2 == 0 ? scale : -scale) * coefficient(number);
    }
    return sum;
}

// Between the means of the fragment's cell and of the one before, which is 0 for the first.
float transmittance() {
    float place = scaled_depth() * float(SHEER_COEFFICIENTS);
    int cell = min(int(place), SHEER_COEFFICIENTS - 1);
    float before = cell > 0 ? absorbance_in(cell - 1) : 0.0;
    return clamp(exp(-mix(before, absorbance_in(cell), place - float(cell))), 0.0, 1.0);
}

void main() {
    begin_fragment();
    vec4 work = clamp(real_work(v_uv, v_tint), 0.0, 1.0);
    if (work.a == 0.0) discard;
    o_sum = transmittance() * vec4(work.rgb * work.a, work.a);
    o_transmittance = work.a;
}
