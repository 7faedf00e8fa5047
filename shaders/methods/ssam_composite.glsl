// Listing 3.2. The additive mask is clamped here because float targets do not saturate.

uniform sampler2D u_opaque;
uniform sampler2D u_mask;
uniform sampler2D u_foliage;

uniform float u_additive_part;
uniform int u_squared;

layout(location = 0) out vec4 o_color;  // no blending
layout(location = 1) out float o_blend;  // the factor, for explanations; frames do not have this output

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 masks = min(texelFetch(u_mask, pixel, 0), 1.0);
    float mask = mix(masks.x, masks.w, u_additive_part);
    if (u_squared != 0) mask *= mask;
    o_blend = mask;
    o_color = vec4(mix(texelFetch(u_opaque, pixel, 0).rgb, texelFetch(u_foliage, pixel, 0).rgb, mask), 1.0);
}
