// Comes after the scene's shading in every program. If SHEER_COUNT_SHADED is set, each call of real_work adds 1 to the
// pixel; its value is layout(early_fragment_tests) in; or nothing. See renderer/counting/shading_counter.h.
#ifdef SHEER_COUNT_SHADED
SHEER_COUNT_SHADED

layout(binding = 0, r32ui) uniform restrict uimage2D u_shaded;

// Pixels of that image per pixel of the picture that is drawn, which may be smaller.
uniform vec2 u_shaded_scale;

#ifdef SHEER_COUNT_WARPS
// See renderer/counting/warp_counter.h: four words for each of u_warp_primitives primitives from u_first_warp_primitive
// on, and then two for each block of each of them: fragments that start, and those that are shaded.
layout(std430, binding = 8) restrict buffer SheerWarps { uint sheer_warps[]; };
uniform uint u_first_warp_primitive, u_warp_primitives;

const uint sheer_no_warp = 0xffffffffu;
uint sheer_warp = sheer_no_warp, sheer_thread;

// Finds the first word of the primitive's block of 8 x 4 pixels, and the fragment's bit; the bit of a started one is set.
void start_in_warp() {
    uint primitive = v_primitive - u_first_warp_primitive;
    sheer_warp = sheer_no_warp;
    if (primitive >= u_warp_primitives) return;
    uint entry = 4u * primitive, size = sheer_warps[entry + 3u];
    ivec2 blocks = ivec2(size & 0xffffu, size >> 16);
    if (blocks.x == 0) return;
    ivec2 corner = ivec2(vec2(sheer_warps[entry + 1u], sheer_warps[entry + 2u]) / u_shaded_scale);
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec2 block = clamp(pixel / ivec2(8, 4) - corner / ivec2(8, 4), ivec2(0), blocks - 1);
    sheer_warp = sheer_warps[entry] + 2u * uint(block.y * blocks.x + block.x);
    sheer_thread = 1u << ((pixel.x & 7) + 8 * (pixel.y & 3));
    atomicOr(sheer_warps[sheer_warp], sheer_thread);
}

void live_in_warp() {
#ifdef SHEER_GATHERS
    start_in_warp();
#endif
    if (sheer_warp != sheer_no_warp) atomicOr(sheer_warps[sheer_warp + 1u], sheer_thread);
}

// The method's own main() is called by the one that is appended to the program.
void main_of_method();
void counted_main() {
#ifndef SHEER_GATHERS
    start_in_warp();
#endif
    main_of_method();
}

#define main main_of_method
#else
void live_in_warp() {}
#endif

vec4 counted_real_work(vec2 uv, vec4 tint) {
    imageAtomicAdd(u_shaded, ivec2(gl_FragCoord.xy * u_shaded_scale), 1u);
    live_in_warp();
    return real_work(uv, tint);
}

#define real_work counted_real_work
#endif
