uniform sampler2D u_opaque_depth;
uniform sampler2D u_last_depth;
uniform usampler2D u_last_primitive;

// No blending; the depth test keeps the nearest.
layout(location = 0) out vec4 o_color;
layout(location = 1) out float o_depth;
layout(location = 2) out uint o_primitive;

void main() {
    begin_fragment();
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float depth = gl_FragCoord.z;
    float last_depth = texelFetch(u_last_depth, pixel, 0).r;
    bool behind_last =
        depth > last_depth || (depth == last_depth && v_primitive < texelFetch(u_last_primitive, pixel, 0).r);
    if (!behind_last || depth > texelFetch(u_opaque_depth, pixel, 0).r) {
        discard;
    } else {
        o_color = clamp(real_work(v_uv, v_tint), 0.0, 1.0);
        o_depth = depth;
        o_primitive = v_primitive;
    }
}
