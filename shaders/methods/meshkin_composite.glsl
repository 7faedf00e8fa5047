// Slide 34. Set before: FULL, 0 or 1.

layout(binding = 8) uniform sampler2D u_opaque;
layout(binding = 9) uniform sampler2D u_sums;
#if FULL
layout(binding = 10) uniform sampler2D u_reciprocals;
layout(binding = 11) uniform sampler2D u_products;

const float largest = 3.0e38;  // as in meshkin_accumulate.glsl; a sum of two such is an infinity again
#endif

layout(location = 0) out vec4 o_color;  // no blending
layout(location = 1) out float o_rest;  // what D is weighed by, for whoever asks; frames have no such output

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 sums = texelFetch(u_sums, pixel, 0);
    float rest = 1.0 - sums.a;
#if FULL
    // An alpha that is nothing in the sums may be the only one.
    float reciprocals = texelFetch(u_reciprocals, pixel, 0).r, product = texelFetch(u_products, pixel, 0).r;
    if (reciprocals == 0.0) discard;
    rest += product - min(reciprocals, largest) * product;
#else
    if (sums.a == 0.0) discard;
#endif
    o_rest = rest;
    o_color = vec4(clamp(sums.rgb + rest * texelFetch(u_opaque, pixel, 0).rgb, 0.0, 1.0), 1.0);
}
