// Enderton et al. 2010, section 5. Set before: SHEER_SAMPLES.
uniform sampler2DMS u_depths;

layout(location = 0) out vec4 o_sum;  // blend ONE, ONE

// A fragment is in front of its own samples: their depths differ from that in the pixel's middle by half a pixel's slope.
void main() {
    begin_fragment();
    float depth = gl_FragCoord.z - 0.5 * fwidth(gl_FragCoord.z) - 1e-6;
    vec4 work = clamp(real_work(v_uv, v_tint), 0.0, 1.0);
    if (work.a == 0.0) discard;
    float seen = 0.0;
    for (int i = 0; i < SHEER_SAMPLES; ++i)
        if (depth <= texelFetch(u_depths, ivec2(gl_FragCoord.xy), i).r) seen += 1.0;
    o_sum = seen * vec4(work.rgb * work.a, work.a);
}
