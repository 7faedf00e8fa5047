uniform sampler2D u_near;

layout(location = 0) out vec4 o_color;  // blend DST_ALPHA, ONE; alpha ZERO, SRC_ALPHA

void main() {
    vec4 color = texelFetch(u_near, ivec2(gl_FragCoord.xy), 0);
    o_color = vec4(color.rgb, 1.0 - color.a);
}
