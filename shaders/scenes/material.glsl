// The shading of a model: the picture of its material, if it has one, times the tint. Set before: TEXTURED, 0 where no
// material has a picture. A main() that uses real_work calls begin_fragment() first.

#if TEXTURED
layout(binding = 3) uniform sampler2DArray u_pictures;

// As in real_work.glsl: derivatives are taken before any branch.
float level_of_detail;

void begin_fragment() {
    vec2 size = vec2(textureSize(u_pictures, 0).xy);
    vec2 dx = dFdx(v_uv) * size, dy = dFdy(v_uv) * size;
    level_of_detail = 0.5 * log2(max(dot(dx, dx), dot(dy, dy)));
}

vec4 real_work(vec2 uv, vec4 tint) {
    int picture = sheer_materials[v_material].picture;
    if (picture < 0) return tint;
    return textureLod(u_pictures, vec3(uv, float(picture)), level_of_detail) * tint;
}
#else
void begin_fragment() {}

vec4 real_work(vec2 uv, vec4 tint) {
    return tint;
}
#endif
