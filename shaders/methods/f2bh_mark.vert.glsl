#version 450 core
// Two triangles for each tile at the nearest depth; those of a closed tile are beyond one side of the view.
uniform usampler2D u_closed_before;  // f2bh_scan.glsl
uniform vec2 u_tiles;                // number of tiles in the image's width and height, in fractions too
uniform uint u_all_closed;           // pixels of a tile

void main() {
    int tile = gl_VertexID / 6, vertex = gl_VertexID % 6, columns = int(ceil(u_tiles.x));
    ivec2 place = ivec2(tile % columns, tile / columns);
    ivec2 corner = ivec2(vertex == 1 || vertex == 2 || vertex == 4, vertex == 2 || vertex == 4 || vertex == 5);
    vec2 fraction = vec2(place + corner) / u_tiles;
    gl_Position = vec4(2.0 * fraction.x - 1.0, 1.0 - 2.0 * fraction.y, 0.0, 1.0);
    if (texelFetch(u_closed_before, place, 0).r == u_all_closed) gl_Position = vec4(2.0, 0.0, 0.0, 1.0);
}
