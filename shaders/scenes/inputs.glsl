// What the vertex stage hands to every fragment of a scene.
in vec3 v_position;  // in the scene's own space
in vec2 v_uv;
in vec4 v_tint;
flat in uint v_primitive;
flat in uint v_material;

