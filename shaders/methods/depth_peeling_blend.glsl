uniform sampler2D u_layer;

layout(location = 0) out vec4 o_color;  // blend DST_ALPHA, ONE; alpha ZERO, SRC_ALPHA

// A pixel without a fragment holds (0, 0, 0, 0), which leaves the accumulation as it is.
void main() {
    vec4 work = texelFetch(u_layer, ivec2(gl_FragCoord.xy), 0);
    o_color = vec4(work.rgb * work.a, 1.0 - work.a);
}
