// The inputs of every fragment of a scene. Set before: SHEER_HAS_CAMERA, 0 or 1, and SHEER_FLAT_TINT, 1 if every
// triangle has one tint, which then reaches the fragments unchanged: interpolated, 0.5 would sometimes be slightly
// less than 0.5.
#ifdef SHEER_GATHERS
// A program over the whole picture, which sets these for each fragment before it shades it.
vec3 v_position;
vec2 v_uv, v_uv_dx, v_uv_dy;
vec4 v_tint;
uint v_primitive, v_material;
vec4 sheer_FragCoord;
bool sheer_FrontFacing;
#define SHEER_UV_DX v_uv_dx
#define SHEER_UV_DY v_uv_dy
#else
in vec3 v_position;  // in the scene's own space
in vec2 v_uv;
#if SHEER_FLAT_TINT
flat
#endif
in vec4 v_tint;
flat in uint v_primitive;
flat in uint v_material;
#define SHEER_UV_DX dFdx(v_uv)
#define SHEER_UV_DY dFdy(v_uv)
#endif

// The fragment's distance from the camera along its axis, in the scene's units. For scenes without a camera, which
// have no units, it is the depth, 0 to 1.
float sheer_distance() {
#if SHEER_HAS_CAMERA
    return 1.0 / gl_FragCoord.w;
#else
    return gl_FragCoord.z;
#endif
}
