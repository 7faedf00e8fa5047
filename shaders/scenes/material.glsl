// The shading of a model: the picture of its material, if it has one, times the tint, and what the material emits. A
// main() that uses real_work calls begin_fragment() first. Set before:
// PICTURE_ARRAYS  how many arrays hold the materials' pictures; 0 if no material has one
// SAMPLERS        1 if a picture is not simply repeated and filtered trilinearly
// EMISSIVE        1 if a material emits light

#if PICTURE_ARRAYS > 0
layout(binding = 3) uniform sampler2DArray u_pictures[PICTURE_ARRAYS];

// As in real_work.glsl: derivatives are taken before any branch.
vec2 uv_dx, uv_dy;

// Samplers are chosen by constants: an index that differs between fragments is not allowed.
#if PICTURE_ARRAYS == 1
#define PICK(array, F) F(0)
#elif PICTURE_ARRAYS == 2
#define PICK(array, F) array == 0 ? F(0) : F(1)
#elif PICTURE_ARRAYS == 3
#define PICK(array, F) array == 0 ? F(0) : array == 1 ? F(1) : F(2)
#elif PICTURE_ARRAYS == 4
#define PICK(array, F) array == 0 ? F(0) : array == 1 ? F(1) : array == 2 ? F(2) : F(3)
#else
#define PICK(array, F) array == 0 ? F(0) : array == 1 ? F(1) : array == 2 ? F(2) : array == 3 ? F(3) : F(4)
#endif

ivec2 picture_size(SheerPicture picture, int level) {
#define SIZE(i) textureSize(u_pictures[i], picture.level + level).xy
    return PICK(picture.array, SIZE);
}

vec4 read_picture(SheerPicture picture, vec2 uv, float level) {
    vec3 at = vec3(uv, float(picture.layer));
    float of_array = float(picture.level) + level;
#define READ(i) textureLod(u_pictures[i], at, of_array)
    return PICK(picture.array, READ);
}

float level_of_detail(SheerPicture picture, vec2 dx, vec2 dy) {
    vec2 size = vec2(picture_size(picture, 0));
    dx *= size;
    dy *= size;
    return 0.5 * log2(max(dot(dx, dx), dot(dy, dy)));
}

#if SAMPLERS
const int wrap_repeat = 0, wrap_clamp = 1;

float wrapped(float at, int wrap) {
    if (wrap == wrap_repeat) return fract(at);
    if (wrap == wrap_clamp) return clamp(at, 0.0, 1.0);
    return 1.0 - abs(mod(at, 2.0) - 1.0);
}

// One mipmap level. The array repeats; half a texel inside the edge, nothing from the opposite side is mixed in.
vec4 read_level(SheerPicture picture, vec2 uv, int level, bool nearest) {
    ivec2 wrap = ivec2(picture.sampling & 3, picture.sampling >> 2 & 3);
    vec2 at = vec2(wrapped(uv.x, wrap.x), wrapped(uv.y, wrap.y));
    ivec2 size = picture_size(picture, level);
    if (nearest) {
        ivec3 texel = ivec3(clamp(ivec2(at * vec2(size)), ivec2(0), size - 1), picture.layer);
        int of_array = picture.level + level;
#define FETCH(i) texelFetch(u_pictures[i], texel, of_array)
        return PICK(picture.array, FETCH);
    }
    vec2 edge = 0.5 / vec2(size);
    vec2 within = clamp(at, edge, 1.0 - edge);
    return read_picture(picture, mix(within, at, equal(wrap, ivec2(wrap_repeat))), float(level));
}

vec4 sample_picture(SheerPicture picture, vec2 uv, vec2 dx, vec2 dy) {
    float detail = level_of_detail(picture, dx, dy);
    bool magnified = detail <= 0.0;
    bool nearest = (picture.sampling & (magnified ? 16 : 32)) != 0;
    int mipmaps = picture.sampling >> 6;  // 0 none, 1 the nearest, 2 the nearest two
#define LEVELS(i) textureQueryLevels(u_pictures[i])
    int last = (PICK(picture.array, LEVELS)) - 1 - picture.level;
    if (magnified || mipmaps == 0) detail = 0.0;
    if (mipmaps == 1) detail = ceil(detail + 0.5) - 1.0;
    detail = clamp(detail, 0.0, float(last));
    int first = int(detail);
    vec4 finer = read_level(picture, uv, first, nearest), coarser = read_level(picture, uv, min(first + 1, last), nearest);
    return mix(finer, coarser, detail - float(first));
}
#else
vec4 sample_picture(SheerPicture picture, vec2 uv, vec2 dx, vec2 dy) {
    return read_picture(picture, uv, max(level_of_detail(picture, dx, dy), 0.0));
}
#endif
#endif

#if EMISSIVE
#ifdef SHEER_GATHERS
vec2 v_emission_uv, v_emission_dx, v_emission_dy;
#else
in vec2 v_emission_uv;
#define v_emission_dx dFdx(v_emission_uv)
#define v_emission_dy dFdy(v_emission_uv)
#endif

vec2 emission_dx, emission_dy;

// IEC 61966-2-1.
vec3 decoded(vec3 color) {
    return mix(pow((color + 0.055) / 1.055, vec3(2.4)), color / 12.92, lessThanEqual(color, vec3(0.04045)));
}

vec3 encoded(vec3 light) {
    return mix(1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055, 12.92 * light, lessThanEqual(light, vec3(0.0031308)));
}

// Lights add up as light, not as display values.
vec3 with_emission(vec3 color) {
    SheerPicture picture = sheer_materials[v_material].emission;
    vec3 emitted = sheer_materials[v_material].emitted;
#if PICTURE_ARRAYS > 0
    if (picture.array >= 0) emitted *= decoded(sample_picture(picture, v_emission_uv, emission_dx, emission_dy).rgb);
#endif
    if (emitted == vec3(0.0)) return color;
    return encoded(min(decoded(max(color, 0.0)) + emitted, 1.0));
}
#endif

void begin_fragment() {
#if PICTURE_ARRAYS > 0
    uv_dx = SHEER_UV_DX;
    uv_dy = SHEER_UV_DY;
#endif
#if EMISSIVE
    emission_dx = v_emission_dx;
    emission_dy = v_emission_dy;
#endif
}

vec4 real_work(vec2 uv, vec4 tint) {
    vec4 color = tint;
#if PICTURE_ARRAYS > 0
    SheerPicture picture = sheer_materials[v_material].base;
    if (picture.array >= 0) color *= sample_picture(picture, uv, uv_dx, uv_dy);
#endif
#if EMISSIVE
    color.rgb = with_emission(color.rgb);
#endif
    return color;
}
