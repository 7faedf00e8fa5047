uniform sampler2D u_opaque;
uniform sampler2D u_sums;
uniform sampler2D u_modulation;

layout(location = 0) out vec4 o_color;  // no blending

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 modulation = texelFetch(u_modulation, pixel, 0).rgb;
    if (modulation == vec3(1.0)) discard;
    vec4 sums = texelFetch(u_sums, pixel, 0);
    // As in wboit_composite.glsl.
    vec3 average = isinf(sums.a) ? vec3(0.0) : sums.rgb / max(sums.a, 1e-5);
    vec3 color = mix(average, texelFetch(u_opaque, pixel, 0).rgb, modulation);
    o_color = vec4(clamp(color, 0.0, 1.0), 1.0);
}
