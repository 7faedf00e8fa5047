uniform sampler2D u_bounds;

// No color output: an occlusion query counts the pixels that have layers left.
void main() {
    if (texelFetch(u_bounds, ivec2(gl_FragCoord.xy), 0).g < 0.0) discard;
}
