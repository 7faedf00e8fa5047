#version 450 core
// Two triangles for each pixel of the coarse picture, at its depth; none if the coarse pixel did not reach the cap.
uniform sampler2D u_coarse_depth;

const vec2 corners[6] = vec2[](vec2(0, 0), vec2(1, 0), vec2(0, 1), vec2(0, 1), vec2(1, 0), vec2(1, 1));

void main() {
    ivec2 size = textureSize(u_coarse_depth, 0);
    int number = gl_VertexID / 6;
    ivec2 block = ivec2(number % size.x, number / size.x);
    float depth = texelFetch(u_coarse_depth, block, 0).r;
    vec2 place = (vec2(block) + corners[gl_VertexID % 6]) / vec2(size);
    // Row 0 is the top one, where y is 1.
    gl_Position = depth < 1.0 ? vec4(2.0 * place.x - 1.0, 1.0 - 2.0 * place.y, depth, 1.0) : vec4(0.0, 0.0, 0.0, 1.0);
}
