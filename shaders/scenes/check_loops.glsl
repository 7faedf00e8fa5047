// Counts, for each pixel, the fragments whose user-defined shading was refused an iteration. No color output.
layout(binding = 0, r32ui) uniform restrict uimage2D u_refused;

uniform bool u_opaque;

void main() {
    begin_fragment();
    bool untextured = u_opaque && v_uv.x < -1e8;
    if (untextured) return;
    real_work(v_uv, v_tint);
    if (sheer_iterations_left < 0) imageAtomicAdd(u_refused, ivec2(gl_FragCoord.xy), 1u);
}
