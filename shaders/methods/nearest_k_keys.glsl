// The keys of the nearest fragments of each pixel, in order: 24 bits of depth, 8 of transmittance. Set before: SHEER_K.
layout(std430, binding = 0) coherent buffer Keys { uint keys[]; };

uniform int u_width;

const uint no_key = 0xffffffffu;

uint first_key() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    return uint(pixel.y * u_width + pixel.x) * uint(SHEER_K);
}

uint depth_part(float depth) { return uint(depth * 16777215.0); }
float transmittance_of(uint key) { return float(key & 255u) / 255.0; }
