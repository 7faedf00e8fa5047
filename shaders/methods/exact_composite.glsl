layout(location = 0) out vec4 o_color;  // blend ONE, SRC_ALPHA for colour; ZERO, ONE for alpha

void main() {
    vec3 color = vec3(0.0);
    float transmittance = 1.0;
    for (uint link = heads[pixel_number()]; link != 0u; link = next_of(link)) {
        uint word = first_word(link);
        vec4 work = uintBitsToFloat(uvec4(nodes[word], nodes[word + 1u], nodes[word + 2u], nodes[word + 3u]));
        color += transmittance * work.a * work.rgb;
        transmittance *= 1.0 - work.a;
    }
    o_color = vec4(color, transmittance);
}
