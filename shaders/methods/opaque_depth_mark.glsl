// The greatest depth where less than u_threshold of the transmittance of a front-to-back accumulation is left, 0 in every
// other pixel, so that nothing needs to be cleared. No color output; depth test ALWAYS with depth writes.
uniform sampler2D u_accumulation;

uniform float u_threshold;

void main() {
    gl_FragDepth = texelFetch(u_accumulation, ivec2(gl_FragCoord.xy), 0).a < u_threshold ? 1.0 : 0.0;
}
