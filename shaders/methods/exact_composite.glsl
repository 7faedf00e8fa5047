uniform sampler2D u_opaque;

layout(location = 0) out vec4 o_color;  // no blending: the target's rounding is the only one

void main() {
    if (gl_HelperInvocation) return;
    vec3 color = vec3(0.0);
    float transmittance = 1.0;
    for (uint link = heads[pixel_number()]; link != 0u; link = next_of(link)) {
        uint word = first_word(link);
        vec4 work = uintBitsToFloat(uvec4(nodes[word], nodes[word + 1u], nodes[word + 2u], nodes[word + 3u]));
        color += transmittance * work.a * work.rgb;
        transmittance *= 1.0 - work.a;
    }
    o_color = vec4(color + transmittance * texelFetch(u_opaque, ivec2(gl_FragCoord.xy), 0).rgb, 1.0);
}
