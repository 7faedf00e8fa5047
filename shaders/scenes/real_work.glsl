// The scene's shading, RealWork of the SCCG 2010 paper, section 2.2. Set before: TEXTURED (0 or 1), MATH (0 or 1: every
// sampled position is bent by trigonometric functions). A main() that uses real_work calls begin_fragment() first.

#if TEXTURED
layout(binding = 0) uniform sampler2DArray u_textures;

// 1, 4 or 16. A uniform, so that the loop stays a loop: llvmpipe runs both sides of a branch and only leaves a loop
// early, once no lane is in it. If the loop were unrolled, a discarded fragment would cost as much as a shaded one.
uniform int u_reads;

const int texture_count = 4;

// Level of detail of every read. It comes from derivatives, which are undefined once neighbours have diverged, so it is
// computed before any branch.
float level_of_detail;

void begin_fragment() {
    vec2 dx = SHEER_UV_DX, dy = SHEER_UV_DY;
    level_of_detail = 0.5 * log2(max(dot(dx, dx), dot(dy, dy))) + log2(float(textureSize(u_textures, 0).x));
}

vec2 position(vec2 uv, float number) {
#if MATH
    vec2 wave = vec2(sin(9.0 * uv.y + number) * cos(5.0 * uv.x - number), cos(8.0 * uv.x + 2.0 * number) * sin(6.0 * uv.y));
    return uv + 0.03 * wave + 0.01 * vec2(sin(21.0 * (uv.x + uv.y)), cos(19.0 * (uv.x - uv.y)));
#else
    return uv;
#endif
}

// The first read shows through the mean of all, so that the picture keeps its shapes however many reads there are.
vec4 real_work(vec2 uv, vec4 tint) {
    vec4 first = vec4(0.0), sum = vec4(0.0);
    for (int i = 0; i < u_reads; ++i) {
        int round = i / texture_count;
        vec2 offset = 0.06 * vec2(float(round & 1), float(round >> 1));
        float image = float((i + int(v_primitive)) % texture_count);
        vec4 read = textureLod(u_textures, vec3(position(uv + offset, float(i)), image), level_of_detail);
        sum += read;
        if (i == 0) first = read;
    }
    return mix(sum / float(u_reads), first, 0.7) * tint;
}
#else
void begin_fragment() {}

vec4 real_work(vec2 uv, vec4 tint) {
    return tint;
}
#endif
