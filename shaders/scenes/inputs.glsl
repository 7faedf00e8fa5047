// What the vertex stage hands to every fragment of a scene. Set before: SHEER_FLAT_TINT, 1 where every triangle has one
// tint, which then reaches the fragments as it is: interpolated, 0.5 would now and then be a little less than 0.5.
in vec3 v_position;  // in the scene's own space
in vec2 v_uv;
#if SHEER_FLAT_TINT
flat
#endif
in vec4 v_tint;
flat in uint v_primitive;
flat in uint v_material;

