// Enderton et al. 2010, sections 3 and 4. Set before: SHEER_CORRECTED, 0 or 1.
uniform sampler2D u_opaque;
uniform sampler2D u_sum;
#if SHEER_CORRECTED
uniform sampler2D u_transmittance;
#endif

uniform float u_samples;  // of a pixel, in all passes

layout(location = 0) out vec4 o_color;  // no blending

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 mean = texelFetch(u_sum, pixel, 0) / u_samples;
    float rest = 1.0 - mean.a;
#if SHEER_CORRECTED
    rest = texelFetch(u_transmittance, pixel, 0).r;
    mean.rgb *= mean.a > 0.0 ? (1.0 - rest) / mean.a : 0.0;
#endif
    if (rest == 1.0) discard;
    o_color = vec4(mean.rgb + rest * texelFetch(u_opaque, pixel, 0).rgb, 1.0);
}
