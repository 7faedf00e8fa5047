// After the user's function, sheer_own_work, so that a driver reports errors about it at its own lines.

// 1. As in real_work.glsl, llvmpipe skips only what is in a loop for discarded fragments.
uniform int u_reads;

vec4 real_work(vec2 uv, vec4 tint) {
    vec4 work = vec4(0.0);
    for (int i = 0; i < u_reads; ++i) work = sheer_own_work(uv, tint);
    return work;
}

