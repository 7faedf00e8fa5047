// The previous frame as the rearmost, opaque layer. Level 1 of its mipmaps is the copy of half the size.
layout(binding = 8) uniform sampler2D u_previous;

layout(location = 0) out vec4 o_color;  // blend DST_ALPHA, ONE; alpha ZERO, SRC_ALPHA

void main() {
    vec2 place = gl_FragCoord.xy / vec2(textureSize(u_previous, 0));
    o_color = vec4(textureLod(u_previous, place, 1.0).rgb, 0.0);
}
