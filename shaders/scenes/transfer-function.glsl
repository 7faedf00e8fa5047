
// The value of a volume at the fragment, and the color that a transfer function gives it. Alpha is that of a slice: it
// already includes the distance between slices. Scene space is camera space.

layout(binding = 1) uniform sampler3D u_volume;
layout(binding = 2) uniform sampler2D u_transfer;  // straight color and alpha by value, one row

uniform mat4 u_to_texture;
uniform vec2 u_value;   // a value is what the texture gives times x, plus y
uniform int u_light;    // 1: lit by the gradient, 0: the color alone
uniform vec3 u_to_sun;  // of length 1

void begin_fragment() {}

float value_at(vec3 at) {
    return textureLod(u_volume, at, 0.0).r * u_value.x + u_value.y;
}

// Lit from both sides, because the clear material may be on either side of a boundary. Where values hardly differ there
// is no boundary to light.
vec3 lit(vec3 color, vec3 at) {
    vec3 voxel = 1.0 / vec3(textureSize(u_volume, 0)), difference;
    for (int axis = 0; axis < 3; ++axis) {
        vec3 offset = vec3(0.0);
        offset[axis] = voxel[axis];
        difference[axis] = value_at(at + offset) - value_at(at - offset);
    }
    vec3 gradient = transpose(mat3(u_to_texture)) * (difference / voxel);
    vec3 normal = gradient / max(length(gradient), 1e-6);
    vec3 to_eye = normalize(-v_position);
    float facing = dot(normal, to_eye);
    if (facing < 0.0) normal = -normal;
    float sun = max(dot(normal, u_to_sun), 0.0);
    float gloss = pow(max(dot(normal, normalize(u_to_sun + to_eye)), 0.0), 24.0);
    vec3 shaded = color * (0.32 + 0.18 * abs(facing) + 0.66 * sun) + 0.16 * gloss;
    return mix(0.8 * color, shaded, smoothstep(0.0, 0.06, length(difference)));
}

vec4 real_work(vec2 uv, vec4 tint) {
    vec3 at = (u_to_texture * vec4(v_position, 1.0)).xyz;
    float entries = float(textureSize(u_transfer, 0).x);
    vec4 color = textureLod(u_transfer, vec2((value_at(at) * (entries - 1.0) + 0.5) / entries, 0.5), 0.0);
    // A loop instead of a branch: llvmpipe runs both sides of a branch, but leaves a loop once no lane is in it.
    int visible = color.a > 0.0 ? u_light : 0;
    for (int i = 0; i < visible; ++i) color.rgb = lit(color.rgb, at);
    return color;
}
