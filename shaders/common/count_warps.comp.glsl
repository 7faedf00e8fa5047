// Counts what scenes/count_shaded.glsl has marked, and forgets it.
layout(local_size_x = 64) in;

layout(std430, binding = 8) restrict buffer SheerWarps { uint sheer_warps[]; };
layout(std430, binding = 9) restrict buffer Sums { uint warps, live_warps, quads, live_quads; };

uniform uint u_begin, u_end;  // of the pairs of words

// A bit for each of the eight groups of 2 x 2 pixels of a block of 8 x 4.
uint quads_of(uint block) {
    uint columns = block | block >> 1;
    return (columns | columns >> 8) & 0x00550055u;
}

void main() {
    uint pair = u_begin + 2u * gl_GlobalInvocationID.x, step = 2u * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    uvec4 sum = uvec4(0u);
    for (; pair < u_end; pair += step) {
        uint started = sheer_warps[pair], live = sheer_warps[pair + 1u];
        if (started == 0u) continue;
        sum += uvec4(started != 0u, live != 0u, bitCount(quads_of(started)), bitCount(quads_of(live)));
        sheer_warps[pair] = 0u;
        sheer_warps[pair + 1u] = 0u;
    }
    atomicAdd(warps, sum.x);
    atomicAdd(live_warps, sum.y);
    atomicAdd(quads, sum.z);
    atomicAdd(live_quads, sum.w);
}
