// Set before: SHEER_FLAT_TINT, see inputs.glsl.
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec2 a_uv;
layout(location = 2) in vec4 a_tint;
layout(location = 3) in uint a_primitive;
layout(location = 4) in uint a_material;
layout(location = 5) in vec2 a_emission_uv;

uniform mat4 u_view_projection;

out vec3 v_position;
out vec2 v_uv;
#if SHEER_FLAT_TINT
flat
#endif
out vec4 v_tint;
flat out uint v_primitive;
flat out uint v_material;
out vec2 v_emission_uv;

// Passes that are drawn with different programs must meet at equal depths.
invariant gl_Position;

#ifdef SHEER_SKIPS
bool sheer_skips(uint primitive);
#endif

void main() {
    gl_Position = u_view_projection * vec4(a_position, 1.0);
#ifdef SHEER_SKIPS
    // All its vertices beyond one side of the view, so that nothing of it is left to rasterise.
    if (sheer_skips(a_primitive)) gl_Position = vec4(2.0, 0.0, 0.0, 1.0);
#endif
    v_position = a_position;
    v_uv = a_uv;
    v_tint = a_tint;
    v_primitive = a_primitive;
    v_material = a_material;
    v_emission_uv = a_emission_uv;
}
