// What f2bg_bin.comp.glsl prepares of a triangle and f2bg.glsl reads: TEXELS vec4 each. Reading them as texels is
// several times as fast on llvmpipe as reading a storage buffer.
const int EDGES = 0;      // three; an edge's value at a place is dot(xy, place - zw), and all are positive inside
const int INVERSE_W = 3;  // the values' sum, each times this, is 1/w; in w: 1 if it faces the camera, -1 if not
const int DEPTH = 4;      // and with this the depth; in w: 1 if the near plane may cut it
const int UVS = 5;        // of three corners; then the numbers of primitive and material
const int TINTS = 7;      // of the last corner, which is that of a triangle with one tint; then of the others
const int POSITIONS = 10; // of three corners, without gaps
const int EMISSION = 13;  // texture coordinates of three corners
const int TEXELS = 15;
