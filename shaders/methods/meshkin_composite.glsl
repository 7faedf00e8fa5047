// Slide 34. Set before: SHEER_FULL, 0 or 1.

uniform sampler2D u_opaque;
uniform sampler2D u_sums;
#if SHEER_FULL
uniform sampler2D u_reciprocals;
uniform sampler2D u_products;

const float largest = 3.0e38;  // as in meshkin_accumulate.glsl; the sum of two of them is again an infinity
#endif

layout(location = 0) out vec4 o_color;  // no blending
layout(location = 1) out float o_rest;  // the weight of D, for explanations; frames do not have this output

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 sums = texelFetch(u_sums, pixel, 0);
    float rest = 1.0 - sums.a;
#if SHEER_FULL
    // An alpha that vanishes in the sums may be the only one.
    float reciprocals = texelFetch(u_reciprocals, pixel, 0).r, product = texelFetch(u_products, pixel, 0).r;
    if (reciprocals == 0.0) discard;
    rest += product - min(reciprocals, largest) * product;
#else
    if (sums.a == 0.0) discard;
#endif
    o_rest = rest;
    o_color = vec4(clamp(sums.rgb + rest * texelFetch(u_opaque, pixel, 0).rgb, 0.0, 1.0), 1.0);
}
