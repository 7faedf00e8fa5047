// Set before: SHEER_MASKED, 1 if the scene has materials with a cutoff.
layout(location = 0) out vec4 o_color;  // no blending

void main() {
    begin_fragment();
    bool untextured = v_uv.x < -1e8;
    vec4 work = v_tint;
    if (!untextured) work = real_work(v_uv, v_tint);
#if SHEER_MASKED
    if (clamp(work.a, 0.0, 1.0) < sheer_materials[v_material].cutoff) discard;
#endif
    o_color = vec4(clamp(work.rgb, 0.0, 1.0), 1.0);
}
