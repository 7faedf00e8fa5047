// A pixel walks the triangles of its tile from near to far, with its color and transmittance in registers, and stops
// when less than u_threshold is left.
// Set before: TILE_PX, WORDS, COARSE_WORDS, SHEER_EMISSION_UVS, 0 or 1, and f2bg_triangle.glsl.

layout(std430, binding = 5) writeonly buffer SheerOpen { uint sheer_open[]; };

uniform samplerBuffer u_triangles;
uniform usamplerBuffer u_masks;
uniform sampler2D u_accumulation;  // color and transmittance after earlier batches
uniform sampler2D u_depth;         // of the opaque pass
uniform float u_threshold;
uniform int u_columns, u_rows;  // of tiles

layout(location = 0) out vec4 o_color;

// The inputs of a fragment at a place, by the perspective-correct weights of the corners, and their derivatives.
// `texel` is the triangle's first.
void interpolate(int texel, vec3 values, mat3x2 slopes, vec4 inverse_w, float depth) {
    vec3 parts = values * inverse_w.xyz;
    float sum = parts.x + parts.y + parts.z;
    vec3 weights = parts / sum;
    vec3 dx = 256.0 * vec3(slopes[0].x, slopes[1].x, slopes[2].x) * inverse_w.xyz;
    vec3 dy = 256.0 * vec3(slopes[0].y, slopes[1].y, slopes[2].y) * inverse_w.xyz;
    vec3 weights_dx = (dx - weights * (dx.x + dx.y + dx.z)) / sum;
    vec3 weights_dy = (dy - weights * (dy.x + dy.y + dy.z)) / sum;
#if SHEER_EMISSION_UVS
    vec4 emission_first = texelFetch(u_triangles, texel + EMISSION), emission_last = texelFetch(u_triangles, texel + EMISSION + 1);
    mat3x2 emission = mat3x2(emission_first.xy, emission_first.zw, emission_last.xy);
    v_emission_uv = emission * weights;
    v_emission_dx = emission * weights_dx;
    v_emission_dy = emission * weights_dy;
#endif
    vec4 uvs_first = texelFetch(u_triangles, texel + UVS), uvs_last = texelFetch(u_triangles, texel + UVS + 1);
    mat3x2 uvs = mat3x2(uvs_first.xy, uvs_first.zw, uvs_last.xy);
    v_uv = uvs * weights;
    v_uv_dx = uvs * weights_dx;
    v_uv_dy = uvs * weights_dy;
    v_primitive = floatBitsToUint(uvs_last.z);
    v_material = floatBitsToUint(uvs_last.w);
    v_tint = texelFetch(u_triangles, texel + TINTS);
#if !SHEER_FLAT_TINT
    v_tint = weights.x * texelFetch(u_triangles, texel + TINTS + 1) + weights.y * texelFetch(u_triangles, texel + TINTS + 2) + weights.z * v_tint;
#endif
    vec4 first = texelFetch(u_triangles, texel + POSITIONS), second = texelFetch(u_triangles, texel + POSITIONS + 1);
    v_position = mat3(first.xyz, vec3(first.w, second.xy), vec3(second.zw, texelFetch(u_triangles, texel + POSITIONS + 2).x)) * weights;
    sheer_FragCoord = vec4(gl_FragCoord.xy, depth, sum);
    sheer_FrontFacing = inverse_w.w > 0.0;
}

// Of a pixel center on an edge, the triangle above it or to its right has it, as on llvmpipe.
bool covers(vec4 edge, float value) {
    return value > 0.0 || (value == 0.0 && (edge.x > 0.0 || (edge.x == 0.0 && edge.y < 0.0)));
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 place = vec2(pixel) * 256.0 + 128.0;
    int tile = pixel.y / TILE_PX * u_columns + pixel.x / TILE_PX;
    int coarse = tile * (WORDS + COARSE_WORDS), fine = coarse + COARSE_WORDS;
    float opaque_depth = texelFetch(u_depth, pixel, 0).r;
    vec4 kept = texelFetch(u_accumulation, pixel, 0);
    for (uint group = 0u; group < uint(COARSE_WORDS) && kept.a >= u_threshold; ++group) {
        for (uint words = texelFetch(u_masks, coarse + int(group)).r; words != 0u && kept.a >= u_threshold; words &= words - 1u) {
            uint word = 32u * group + uint(findLSB(words));
            for (uint bits = texelFetch(u_masks, fine + int(word)).r; bits != 0u && kept.a >= u_threshold; bits &= bits - 1u) {
                uint number = 32u * word + uint(findLSB(bits));
                int texel = int(number) * TEXELS;
                vec3 values;
                mat3x2 slopes;
                bool covered = true;
                for (int i = 0; i < 3; ++i) {
                    vec4 edge = texelFetch(u_triangles, texel + EDGES + i);
                    precise vec2 parts = edge.xy * (place - edge.zw);
                    precise float value = parts.x + parts.y;
                    values[i] = value;
                    slopes[i] = edge.xy;
                    covered = covered && covers(edge, value);
                }
                // A loop instead of a branch: llvmpipe runs both sides of a branch, but leaves a loop once no lane is
                // in it.
                for (int i = covered ? 1 : 0; i > 0; --i) {
                    vec4 depths = texelFetch(u_triangles, texel + DEPTH);
                    float depth = dot(values, depths.xyz);
                    if (depth > opaque_depth || (depths.w != 0.0 && depth < 0.0)) continue;
                    interpolate(texel, values, slopes, texelFetch(u_triangles, texel + INVERSE_W), depth);
                    begin_fragment();
                    vec4 work = clamp(real_work(v_uv, v_tint), 0.0, 1.0);
                    kept = vec4(kept.rgb + kept.a * work.a * work.rgb, kept.a * (1.0 - work.a));
                }
            }
        }
    }
    if (kept.a >= u_threshold) {
        sheer_open[tile] = 1u;
        sheer_open[u_columns * u_rows] = 1u;
    }
    o_color = kept;
}
