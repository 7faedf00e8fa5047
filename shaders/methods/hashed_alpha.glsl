// Wyman and McGuire 2017, section 3. Set before: common/hash.glsl.
uniform float u_hash_scale;
uniform uint u_seed;
uniform bool u_hashes_primitive;

layout(location = 0) out vec4 o_color;  // no blending; depth test and depth writes

float grain(float scale, vec3 position) {
    ivec3 cell = ivec3(floor(scale * position));
    uint layer = u_hashes_primitive ? v_primitive + 1u : 0u;
    return unit_number(hashed(uint(cell.x), hashed(uint(cell.y), hashed(uint(cell.z), hashed(layer, u_seed)))));
}

// The distribution of (1 - t) a + t b, if a and b are evenly distributed from 0 to 1.
float distribution(float x, float t) {
    float least = min(t, 1.0 - t), product = 2.0 * least * (1.0 - least);
    if (x < least) return x * x / product;
    if (x < 1.0 - least) return (x - 0.5 * least) / (1.0 - least);
    return 1.0 - (1.0 - x) * (1.0 - x) / product;
}

// Grains of the two powers of 2 around a pixel's size, fixed to the object, blended so that the change from one size to
// the next is not seen.
float threshold(vec3 dx, vec3 dy) {
    float size = u_hash_scale * max(length(dx), length(dy));
    float level = -log2(max(size, 1e-30)), fine = ceil(level), coarse = floor(level);
    float t = level - coarse;
    float x = mix(grain(exp2(coarse), v_position), grain(exp2(fine), v_position), t);
    return clamp(t == 0.0 ? x : distribution(x, t), 1e-6, 1.0);
}

void main() {
    begin_fragment();
    vec3 dx = dFdx(v_position), dy = dFdy(v_position);
    vec4 work = clamp(real_work(v_uv, v_tint), 0.0, 1.0);
    if (work.a < threshold(dx, dy)) discard;
    o_color = vec4(work.rgb, 1.0);
}
