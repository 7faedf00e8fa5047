uniform sampler2D u_depth;

// No color output; depth test ALWAYS with depth writes.
void main() {
    gl_FragDepth = texelFetch(u_depth, ivec2(gl_FragCoord.xy), 0).r;
}
