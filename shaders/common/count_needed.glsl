// F2B that counts, for each pixel, the fragments that find at least u_threshold of the transmittance left. Reads the
// texture that it draws to, each texel once and by the fragment that writes it, which is defined after a texture
// barrier (OpenGL 4.5, section 9.3.1) as long as no two fragments of a draw share a pixel.
uniform float u_threshold;

uniform sampler2D u_alpha;
layout(binding = 0, r32ui) uniform restrict uimage2D u_needed;

layout(location = 0) out vec4 o_color;  // blend DST_ALPHA, ONE; alpha ZERO, SRC_ALPHA

void main() {
    begin_fragment();
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    if (texelFetch(u_alpha, pixel, 0).a >= u_threshold) imageAtomicAdd(u_needed, pixel, 1u);
    vec4 work = clamp(real_work(v_uv, v_tint), 0.0, 1.0);
    o_color = vec4(work.rgb * work.a, 1.0 - work.a);
}
