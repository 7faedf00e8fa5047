// Per-pixel lists of fragments. A node is 7 words: red, green, blue, alpha, depth, primitive, next. "next" and the heads
// are 0 at the end of a list, otherwise the node's number plus 1.

layout(std430, binding = 0) coherent buffer Nodes { uint nodes[]; };
layout(std430, binding = 1) coherent buffer Heads {
    uint node_count;
    uint heads[];
};

uniform int u_tile_x, u_tile_y, u_tile_width;

const uint node_words = 7u;

uint pixel_number() {
    ivec2 pixel = ivec2(gl_FragCoord.xy) - ivec2(u_tile_x, u_tile_y);
    return uint(pixel.y * u_tile_width + pixel.x);
}

uint first_word(uint link) { return (link - 1u) * node_words; }
uint next_of(uint link) { return nodes[first_word(link) + 6u]; }
void set_next(uint link, uint next) { nodes[first_word(link) + 6u] = next; }

// Nearer first; of equal depths, the primitive submitted later counts as nearer.
bool goes_before(uint a, uint b) {
    float depth_a = uintBitsToFloat(nodes[first_word(a) + 4u]), depth_b = uintBitsToFloat(nodes[first_word(b) + 4u]);
    if (depth_a != depth_b) return depth_a < depth_b;
    return nodes[first_word(a) + 5u] > nodes[first_word(b) + 5u];
}
