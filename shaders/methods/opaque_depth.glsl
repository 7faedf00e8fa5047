// Set before: one of SHEER_SHADER_DEPTH, SHEER_OPAQUE_ONLY and SHEER_TRANSLUCENT_ONLY.
// A fragment counts as transparent or opaque if its alpha is within u_half_step of 0 or 1, which is less than the
// target can resolve.
uniform float u_half_step;

layout(location = 0) out vec4 o_color;  // blend DST_ALPHA, ONE; alpha ZERO, SRC_ALPHA

#if defined(SHEER_SHADER_DEPTH)
// The depth buffer holds marks, so the depth of the opaque pass is read as a texture to see what it hides.
uniform sampler2D u_opaque_depth;

// Places in the order of drawing: of the first triangle of this draw, and of the first triangle of the batch.
uniform int u_first_triangle, u_batch_triangle;

// Marks stay above the 0 of translucent fragments. The first is the u_first-th step below the greatest depth, 1; each
// triangle goes u_step further down. A step is one of u_steps equal ones; in a depth buffer of floats, where that is 0, it
// is the next smaller float.
uniform int u_first, u_step, u_steps;

float mark() {
    int number = u_first + u_step * (u_first_triangle - u_batch_triangle + gl_PrimitiveID);
    if (u_steps == 0) return intBitsToFloat(max(floatBitsToInt(1.0) - number, 1));
    return float(max(u_steps - number, 1)) / float(u_steps);
}
#endif

void main() {
    begin_fragment();
#if defined(SHEER_SHADER_DEPTH)
    if (gl_FragCoord.z > texelFetch(u_opaque_depth, ivec2(gl_FragCoord.xy), 0).r) discard;
#endif
    vec4 work = clamp(real_work(v_uv, v_tint), 0.0, 1.0);
    bool is_opaque = work.a > 1.0 - u_half_step;
    if (work.a < u_half_step) discard;
#if defined(SHEER_SHADER_DEPTH)
    gl_FragDepth = is_opaque ? mark() : 0.0;
#elif defined(SHEER_OPAQUE_ONLY)
    if (!is_opaque) discard;
#else
    if (is_opaque) discard;
#endif
    o_color = vec4(work.rgb * work.a, 1.0 - work.a);
}
