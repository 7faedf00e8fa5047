// Prepares the triangles of a batch, near to far, and sets a bit of each for every open tile that it may touch.
// Set before: TILE_PX, WORDS, COARSE_WORDS, VERTEX_WORDS, SHEER_EMISSION_UVS, 0 or 1, and f2bg_triangle.glsl.

layout(local_size_x = 64) in;

layout(std430, binding = 0) readonly buffer SheerVertices { uint sheer_vertices[]; };  // VERTEX_WORDS each
layout(std430, binding = 1) readonly buffer SheerIndices { uint sheer_indices[]; };
layout(std430, binding = 2) writeonly buffer SheerTexels { vec4 sheer_texels[]; };
// Of each tile: a bit for every word that has a bit, then the words, with a bit for every triangle.
layout(std430, binding = 3) buffer SheerMasks { uint sheer_masks[]; };
#if SHEER_EMISSION_UVS
layout(std430, binding = 6) readonly buffer SheerEmissionUvs { vec2 sheer_emission_uvs[]; };
#endif
// Of each tile, whether it has an open pixel, and then whether any has.
layout(std430, binding = 5) readonly buffer SheerOpen { uint sheer_open[]; };

uniform mat4 u_view_projection;
uniform int u_columns, u_rows;  // of tiles
uniform vec2 u_size_px;
uniform uint u_first;  // triangle of the batch
uniform uint u_count;

struct SheerTriangle {
    vec4 edges[3];
    vec4 inverse_w;
    vec4 depth;
};

float number_at(uint at) {
    return uintBitsToFloat(sheer_vertices[at]);
}

vec3 position_at(uint corner) {
    return vec3(number_at(corner), number_at(corner + 1u), number_at(corner + 2u));
}

vec2 uv_at(uint corner) {
    return vec2(number_at(corner + 3u), number_at(corner + 4u));
}

vec4 tint_at(uint corner) {
    return vec4(number_at(corner + 5u), number_at(corner + 6u), number_at(corner + 7u), number_at(corner + 8u));
}

void write(uint number, SheerTriangle triangle, uvec3 vertices) {
    uint texel = number * uint(TEXELS);
    uvec3 corners = vertices * VERTEX_WORDS;
    vec3 a = position_at(corners.x), b = position_at(corners.y), c = position_at(corners.z);
    for (int i = 0; i < 3; ++i) sheer_texels[texel + uint(EDGES + i)] = triangle.edges[i];
    sheer_texels[texel + uint(INVERSE_W)] = triangle.inverse_w;
    sheer_texels[texel + uint(DEPTH)] = triangle.depth;
    vec2 numbers = uintBitsToFloat(uvec2(sheer_vertices[corners.z + 9u], sheer_vertices[corners.z + 10u]));
    sheer_texels[texel + uint(UVS)] = vec4(uv_at(corners.x), uv_at(corners.y));
    sheer_texels[texel + uint(UVS + 1)] = vec4(uv_at(corners.z), numbers);
    sheer_texels[texel + uint(TINTS)] = tint_at(corners.z);
    sheer_texels[texel + uint(TINTS + 1)] = tint_at(corners.x);
    sheer_texels[texel + uint(TINTS + 2)] = tint_at(corners.y);
    sheer_texels[texel + uint(POSITIONS)] = vec4(a, b.x);
    sheer_texels[texel + uint(POSITIONS + 1)] = vec4(b.yz, c.xy);
    sheer_texels[texel + uint(POSITIONS + 2)] = vec4(c.z, 0.0, 0.0, 0.0);
#if SHEER_EMISSION_UVS
    sheer_texels[texel + uint(EMISSION)] = vec4(sheer_emission_uvs[vertices.x], sheer_emission_uvs[vertices.y]);
    sheer_texels[texel + uint(EMISSION + 1)] = vec4(sheer_emission_uvs[vertices.z], 0.0, 0.0);
#endif
}

// In 1/256 px, as rasterizers place vertices, from the top left corner.
vec2 window_position(vec4 clip) {
    vec2 fraction = vec2(0.5 + 0.5 * clip.x / clip.w, 0.5 - 0.5 * clip.y / clip.w);
    return floor(fraction * u_size_px * 256.0 + 0.5);
}

// The edge's origin is the same vertex whichever way it is walked, so two triangles that share it compute one value.
vec4 edge(vec2 from, vec2 to, float sign_of_area) {
    vec2 slope = vec2(from.y - to.y, to.x - from.x) * sign_of_area;
    bool swaps = to.x < from.x || (to.x == from.x && to.y < from.y);
    return vec4(slope, swaps ? to : from);
}

// Of a triangle in front of the eye.
bool set_up_plain(vec4 clip[3], out SheerTriangle triangle, out vec4 bounds) {
    vec2 at[3];
    for (int i = 0; i < 3; ++i) at[i] = window_position(clip[i]);
    float area = (at[1].x - at[0].x) * (at[2].y - at[0].y) - (at[1].y - at[0].y) * (at[2].x - at[0].x);
    float turn = sign(area);
    for (int i = 0; i < 3; ++i) {
        int from = (i + 1) % 3, to = (i + 2) % 3;
        triangle.edges[i] = edge(at[from], at[to], turn);
        triangle.inverse_w[i] = 1.0 / (clip[i].w * abs(area));
        triangle.depth[i] = clip[i].z / (clip[i].w * abs(area));
    }
    // The origin is at the top, so what is counterclockwise for OpenGL has a negative area here.
    triangle.inverse_w.w = -turn;
    triangle.depth.w = float(min(min(clip[0].z, clip[1].z), clip[2].z) < 0.0);
    bounds = vec4(min(min(at[0], at[1]), at[2]), max(max(at[0], at[1]), at[2]));
    return area != 0.0;
}

// Of one that reaches behind the eye: homogeneous edges (Olano, Greer, Triangle Scan Conversion using 2D Homogeneous
// Coordinates, Graphics Hardware 1997). Their value is the barycentric coordinate divided by w.
bool set_up_crossing(vec4 clip[3], out SheerTriangle triangle, out vec4 bounds) {
    mat3 corners;
    for (int i = 0; i < 3; ++i)
        corners[i] = vec3(128.0 * u_size_px * vec2(clip[i].w + clip[i].x, clip[i].w - clip[i].y), clip[i].w);
    float volume = determinant(corners);
    mat3 rows = transpose(inverse(corners));
    for (int i = 0; i < 3; ++i) {
        vec3 row = rows[i];
        vec2 origin = abs(row.x) > abs(row.y) ? vec2(-row.z / row.x, 0.0) : vec2(0.0, -row.z / row.y);
        triangle.edges[i] = vec4(row.xy, origin);
        triangle.inverse_w[i] = 1.0;
        triangle.depth[i] = clip[i].z;
    }
    triangle.inverse_w.w = -sign(volume);
    triangle.depth.w = 1.0;
    bounds = vec4(0.0, 0.0, u_size_px * 256.0);
    return volume != 0.0 && !isinf(volume) && !isnan(volume);
}

// The greatest value of the edge at pixel centers of the rectangle.
float greatest(vec4 edge, vec2 first, vec2 last) {
    vec2 best = mix(first, last, greaterThan(edge.xy, vec2(0.0)));
    return dot(edge.xy, best - edge.zw);
}

void main() {
    uint number = gl_GlobalInvocationID.x;
    uint tiles = uint(u_columns * u_rows);
    if (number >= u_count || sheer_open[tiles] == 0u) return;
    vec4 clip[3];
    uint index = 3u * (u_first + number);
    uvec3 vertices = uvec3(sheer_indices[index], sheer_indices[index + 1u], sheer_indices[index + 2u]);
    for (int i = 0; i < 3; ++i) clip[i] = u_view_projection * vec4(position_at(vertices[i] * VERTEX_WORDS), 1.0);
    float nearest_w = min(min(clip[0].w, clip[1].w), clip[2].w), farthest_w = max(max(clip[0].w, clip[1].w), clip[2].w);
    SheerTriangle triangle;
    vec4 bounds;
    bool drawn = nearest_w > 1e-6 ? set_up_plain(clip, triangle, bounds)
                                  : farthest_w > 0.0 && set_up_crossing(clip, triangle, bounds);
    if (!drawn) return;
    write(number, triangle, vertices);
    // A tile may only be touched where it has pixel centers.
    ivec2 first = max(ivec2(floor((bounds.xy - 128.0) / (256.0 * TILE_PX))), ivec2(0));
    ivec2 last = min(ivec2(floor((bounds.zw - 128.0) / (256.0 * TILE_PX))), ivec2(u_columns, u_rows) - 1);
    uint word = number / 32u, words = WORDS + COARSE_WORDS;
    for (int y = first.y; y <= last.y; ++y) {
        for (int x = first.x; x <= last.x; ++x) {
            uint tile = uint(y * u_columns + x);
            if (sheer_open[tile] == 0u) continue;
            vec2 top_left = vec2(x, y) * 256.0 * TILE_PX + 128.0, bottom_right = top_left + 256.0 * (TILE_PX - 1.0);
            bool misses = false;
            for (int i = 0; i < 3; ++i) misses = misses || greatest(triangle.edges[i], top_left, bottom_right) < 0.0;
            if (misses) continue;
            if (atomicOr(sheer_masks[tile * words + COARSE_WORDS + word], 1u << (number & 31u)) == 0u)
                atomicOr(sheer_masks[tile * words + word / 32u], 1u << (word & 31u));
        }
    }
}
