layout(early_fragment_tests) in;

// A fragment is 6 words: red, green, blue, alpha, depth, primitive. The scissor leaves one pixel, so no lists are
// needed.
layout(std430, binding = 0) writeonly buffer Fragments { uint fragments[]; };
layout(std430, binding = 1) buffer Count { uint fragment_count; };

const uint fragment_words = 6u;

// No color output: the color mask is off.
void main() {
    begin_fragment();
    vec4 work = clamp(real_work(v_uv, v_tint), 0.0, 1.0);
    uint word = atomicAdd(fragment_count, 1u) * fragment_words;
    if (word + fragment_words > uint(fragments.length())) return;
    for (uint i = 0u; i < 4u; ++i) fragments[word + i] = floatBitsToUint(work[i]);
    fragments[word + 4u] = floatBitsToUint(gl_FragCoord.z);
    fragments[word + 5u] = v_primitive;
}
