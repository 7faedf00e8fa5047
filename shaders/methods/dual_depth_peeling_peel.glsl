// Bavoil and Myers 2008, section 2. The bounds are minus the nearest and the farthest depth that is left.
uniform sampler2D u_bounds;

layout(location = 0) out vec2 o_bounds;  // blend equation MAX
// Premultiplied; blend ONE, ONE_MINUS_SRC_ALPHA, so that of equal depths the one submitted later is over the others.
layout(location = 1) out vec4 o_near;
layout(location = 2) out vec4 o_far;

void main() {
    begin_fragment();
    vec2 bounds = texelFetch(u_bounds, ivec2(gl_FragCoord.xy), 0).rg;
    float depth = gl_FragCoord.z, nearest = -bounds.x, farthest = bounds.y;
    if (depth < nearest || depth > farthest) discard;
    o_bounds = vec2(-2.0);
    o_near = vec4(0.0);
    o_far = vec4(0.0);
    if (depth > nearest && depth < farthest) {
        o_bounds = vec2(-depth, depth);
    } else {
        vec4 work = clamp(real_work(v_uv, v_tint), 0.0, 1.0);
        vec4 color = vec4(work.rgb * work.a, work.a);
        if (depth == nearest) {
            o_near = color;
        } else {
            o_far = color;
        }
    }
}
