// McGuire and Bavoil 2013, equation 6.
uniform sampler2D u_opaque;
uniform sampler2D u_sums;
uniform sampler2D u_revealage;

layout(location = 0) out vec4 o_color;  // no blending

const float least = 1e-30;  // where every weight was rounded to 0

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float revealage = texelFetch(u_revealage, pixel, 0).r;
    if (revealage == 1.0) discard;
    vec4 sums = texelFetch(u_sums, pixel, 0);
    // Infinity by infinity is no number, which drivers usually show as black. Written here, it is so on all that have it.
    vec3 average = isinf(sums.a) ? vec3(0.0) : sums.rgb / max(sums.a, least);
    o_color = vec4(mix(average, texelFetch(u_opaque, pixel, 0).rgb, revealage), 1.0);
}
