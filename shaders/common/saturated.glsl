// Passes where less than u_threshold of the transmittance of a front-to-back accumulation is left. No early fragment
// tests: depth must not be written before the discard. Reads of a channel that is drawn to at the same time would be
// undefined, so the framebuffer has a depth buffer only.
uniform sampler2D u_accumulation;

uniform float u_threshold;

void main() {
    if (texelFetch(u_accumulation, ivec2(gl_FragCoord.xy), 0).a >= u_threshold) discard;
}
