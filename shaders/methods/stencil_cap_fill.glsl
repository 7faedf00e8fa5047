// The previous frame as the rearmost, opaque layer. Level 1 of its mipmaps is the copy of half the size.
// Set before: SHEER_COUNTED, 1 if the fragments of each pixel have been counted because the stencil only shows that the
// cap was reached.
uniform sampler2D u_previous;

layout(location = 0) out vec4 o_color;  // blend DST_ALPHA, ONE; alpha ZERO, SRC_ALPHA

#if SHEER_COUNTED
uniform sampler2D u_count;
uniform float u_cap;
#endif

void main() {
#if SHEER_COUNTED
    if (texelFetch(u_count, ivec2(gl_FragCoord.xy), 0).r <= u_cap) discard;
#endif
    vec2 place = gl_FragCoord.xy / vec2(textureSize(u_previous, 0));
    o_color = vec4(textureLod(u_previous, place, 1.0).rgb, 0.0);
}
