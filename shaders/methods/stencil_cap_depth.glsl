// Set before: SHEER_ALPHA_TEST, 0 or 1, as for stencil_cap.glsl. No color output; the stencil lets one depth through.
uniform float u_least_alpha;

void main() {
    begin_fragment();
#if SHEER_ALPHA_TEST
    if (clamp(real_work(v_uv, v_tint).a, 0.0, 1.0) < u_least_alpha) discard;
#endif
}
