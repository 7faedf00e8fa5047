// For each tile: how many of its pixels, row by row, are closed before the first open one; TILE_PX * TILE_PX if none is
// open. A closed pixel never opens again, so every scan goes on where the last one stopped.
// Set before: TILE_PX.
layout(location = 0) out uint o_closed_before;

uniform usampler2D u_closed_before;  // what is drawn to: a fragment reads its own texel before it writes it
uniform sampler2D u_accumulation;
uniform float u_threshold;

void main() {
    // Beyond an odd last row or column a device runs helpers, which would count on without end: their tile has no size.
    if (gl_HelperInvocation) return;
    ivec2 tile = ivec2(gl_FragCoord.xy), corner_px = tile * TILE_PX;
    ivec2 size_px = min(textureSize(u_accumulation, 0) - corner_px, TILE_PX);
    uint pixels = uint(size_px.x * size_px.y), closed = texelFetch(u_closed_before, tile, 0).r;
    while (closed < pixels) {
        ivec2 pixel = corner_px + ivec2(closed % uint(size_px.x), closed / uint(size_px.x));
        if (texelFetch(u_accumulation, pixel, 0).a >= u_threshold) break;
        ++closed;
    }
    o_closed_before = closed < pixels ? closed : uint(TILE_PX * TILE_PX);
}
