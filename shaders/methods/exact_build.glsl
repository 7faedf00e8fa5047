layout(early_fragment_tests) in;

// No color output: the color mask is off.
void main() {
    begin_fragment();
    vec4 work = clamp(real_work(v_uv, v_tint), 0.0, 1.0);
    uint link = atomicAdd(node_count, 1u) + 1u;
    uint word = first_word(link);
    if (word + node_words > uint(nodes.length())) return;
    nodes[word] = floatBitsToUint(work.r);
    nodes[word + 1u] = floatBitsToUint(work.g);
    nodes[word + 2u] = floatBitsToUint(work.b);
    nodes[word + 3u] = floatBitsToUint(work.a);
    nodes[word + 4u] = floatBitsToUint(gl_FragCoord.z);
    nodes[word + 5u] = v_primitive;
    nodes[word + 6u] = atomicExchange(heads[pixel_number()], link);
}
