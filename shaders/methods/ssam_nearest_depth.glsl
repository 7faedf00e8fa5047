uniform sampler2DMS u_depth;

uniform int u_samples;

// No color output: the color mask is off. The depth test always passes.
void main() {
    float nearest = 1.0;
    for (int i = 0; i < u_samples; ++i) nearest = min(nearest, texelFetch(u_depth, ivec2(gl_FragCoord.xy), i).r);
    gl_FragDepth = nearest;
}
