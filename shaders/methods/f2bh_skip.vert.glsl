// A primitive is skipped if the tiles under its rectangle are all closed, which four reads of a summed-area table tell.
uniform usampler2D u_tile_rects;  // of each primitive, 4096 a row: left, top, right, bottom, 8 bits each from the lowest on
uniform usampler2D u_open_tiles;  // f2bh_sum.glsl

uint sheer_open_up_to(int x, int y) {
    return x < 0 || y < 0 ? 0u : texelFetch(u_open_tiles, ivec2(x, y), 0).r;
}

bool sheer_skips(uint primitive) {
    uint rect = texelFetch(u_tile_rects, ivec2(primitive % 4096u, primitive / 4096u), 0).r;
    int left = int(rect & 255u) - 1, top = int(rect >> 8 & 255u) - 1;
    int right = int(rect >> 16 & 255u), bottom = int(rect >> 24);
    return sheer_open_up_to(right, bottom) + sheer_open_up_to(left, top) ==
           sheer_open_up_to(left, bottom) + sheer_open_up_to(right, top);
}
