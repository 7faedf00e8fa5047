// Slide 34. Set before: FULL, 0 or 1; LARGEST, the largest number that the targets hold.

layout(binding = 8) uniform sampler2D u_opaque;
layout(binding = 9) uniform sampler2D u_sums;
#if FULL
layout(binding = 10) uniform sampler2D u_reciprocals;
layout(binding = 11) uniform sampler2D u_products;
#endif

layout(location = 0) out vec4 o_color;  // no blending
layout(location = 1) out float o_rest;  // what D is weighed by, for whoever asks; frames have no such output

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 sums = texelFetch(u_sums, pixel, 0);
    if (sums.a == 0.0) discard;
    float rest = 1.0 - sums.a;
#if FULL
    float product = texelFetch(u_products, pixel, 0).r;
    rest += product - min(texelFetch(u_reciprocals, pixel, 0).r, LARGEST) * product;
#endif
    o_rest = rest;
    o_color = vec4(clamp(sums.rgb + rest * texelFetch(u_opaque, pixel, 0).rgb, 0.0, 1.0), 1.0);
}
