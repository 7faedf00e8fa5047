// Set before: SHEER_KEEPS_REST, 0 or 1.
layout(location = 0) out vec4 o_near;  // blend ONE, ONE
#if SHEER_KEEPS_REST
layout(location = 1) out vec4 o_rest;           // blend ONE, ONE
layout(location = 2) out float o_rest_opacity;  // blend ZERO, ONE_MINUS_SRC_COLOR
#endif

// Of the nearest fragments, how much of this one is seen: what those in front of it let through; those of its depth
// share it. -1 if this one is not among them.
float visibility() {
    uint first = first_key(), depth = depth_part(gl_FragCoord.z);
    float transmittance = 1.0, seen = 0.0, count = 0.0;
    for (uint i = 0u; i < uint(SHEER_K); ++i) {
        uint key = keys[first + i];
        if (key == no_key || key >> 8 > depth) break;
        if (key >> 8 == depth) {
            seen += transmittance;
            count += 1.0;
        }
        transmittance *= transmittance_of(key);
    }
    return count > 0.0 ? seen / count : -1.0;
}

void main() {
    begin_fragment();
    float seen = visibility();
#if SHEER_KEEPS_REST
    vec4 work = clamp(real_work(v_uv, v_tint), 0.0, 1.0);
    vec4 color = vec4(work.rgb * work.a, work.a);
    bool is_near = seen >= 0.0;
    o_near = is_near ? seen * color : vec4(0.0);
    o_rest = is_near ? vec4(0.0) : color;
    o_rest_opacity = is_near ? 0.0 : work.a;
#else
    if (seen < 0.0) discard;
    vec4 work = clamp(real_work(v_uv, v_tint), 0.0, 1.0);
    o_near = seen * vec4(work.rgb * work.a, work.a);
#endif
}
