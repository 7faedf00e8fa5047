// The number of open tiles above and to the left of each tile, itself included: a summed-area table (Crow, SIGGRAPH 1984),
// made by summing rows and then columns.
// Set before: SHEER_SUM_ROWS, 1 for rows and 0 for columns; TILE_PX.
layout(location = 0) out uint o_sum;

uniform usampler2D u_summed;  // rows: f2bh_scan.glsl; columns: the sums of rows

void main() {
    ivec2 tile = ivec2(gl_FragCoord.xy);
    uint sum = 0u;
#if SHEER_SUM_ROWS
    for (int x = 0; x <= tile.x; ++x)
        sum += texelFetch(u_summed, ivec2(x, tile.y), 0).r < uint(TILE_PX * TILE_PX) ? 1u : 0u;
#else
    for (int y = 0; y <= tile.y; ++y) sum += texelFetch(u_summed, ivec2(tile.x, y), 0).r;
#endif
    o_sum = sum;
}
