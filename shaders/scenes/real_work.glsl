// The scene's shading, RealWork of the SCCG 2010 paper, section 2.2. Set before: TEXTURES (0, 1 or 4),
// SAMPLES_PER_TEXTURE (1 or 4), MATH (0 or 1: every sampled position is bent by trigonometric functions).

in vec2 v_uv;
in vec4 v_tint;
flat in uint v_primitive;

#if TEXTURES > 0
layout(binding = 0) uniform sampler2D u_texture_0;
layout(binding = 1) uniform sampler2D u_texture_1;
layout(binding = 2) uniform sampler2D u_texture_2;
layout(binding = 3) uniform sampler2D u_texture_3;

vec2 position(vec2 uv, float number) {
#if MATH
    vec2 wave = vec2(sin(9.0 * uv.y + number) * cos(5.0 * uv.x - number), cos(8.0 * uv.x + 2.0 * number) * sin(6.0 * uv.y));
    return uv + 0.03 * wave + 0.01 * vec2(sin(21.0 * (uv.x + uv.y)), cos(19.0 * (uv.x - uv.y)));
#else
    return uv;
#endif
}

vec4 samples(sampler2D image, vec2 uv, float number) {
#if SAMPLES_PER_TEXTURE == 1
    return texture(image, position(uv, number));
#else
    vec4 sum = texture(image, position(uv, number));
    sum += texture(image, position(uv + vec2(0.07, 0.02), number + 1.0));
    sum += texture(image, position(uv + vec2(-0.03, 0.06), number + 2.0));
    sum += texture(image, position(uv + vec2(0.04, -0.05), number + 3.0));
    return sum * 0.25;
#endif
}
#endif

vec4 real_work(vec2 uv, vec4 tint) {
#if TEXTURES == 0
    return tint;
#elif TEXTURES == 1
    return samples(u_texture_0, uv, 0.0) * tint;
#else
    vec4 sum = samples(u_texture_0, uv, 0.0) + samples(u_texture_1, uv, 4.0) + samples(u_texture_2, uv, 8.0) +
               samples(u_texture_3, uv, 12.0);
    return sum * 0.25 * tint;
#endif
}
