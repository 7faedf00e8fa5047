// Bavoil and Myers, section 3: N equal layers of the average color and alpha.
uniform sampler2D u_opaque;
uniform sampler2D u_sums;
uniform sampler2D u_count;

layout(location = 0) out vec4 o_color;  // no blending
layout(location = 1) out float o_rest;  // the weight of the opaque color, for explanations

// pow() is not exact enough for thousands of layers.
float power(float base, uint exponent) {
    float result = 1.0;
    for (; exponent != 0u; exponent >>= 1) {
        if ((exponent & 1u) != 0u) result *= base;
        base *= base;
    }
    return result;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 sums = texelFetch(u_sums, pixel, 0);
    if (sums.a == 0.0) discard;
    float count = texelFetch(u_count, pixel, 0).r;
    float rest = power(max(1.0 - sums.a / count, 0.0), uint(count));
    o_rest = rest;
    o_color = vec4(mix(sums.rgb / sums.a, texelFetch(u_opaque, pixel, 0).rgb, rest), 1.0);
}
