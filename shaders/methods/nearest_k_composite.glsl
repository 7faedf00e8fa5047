// Set before: SHEER_KEEPS_REST and SHEER_AVERAGES_REST, 0 or 1.
uniform sampler2D u_opaque;
uniform sampler2D u_near;
#if SHEER_KEEPS_REST
uniform sampler2D u_rest;
uniform sampler2D u_rest_transmittance;
#endif

layout(location = 0) out vec4 o_color;         // no blending
layout(location = 1) out float o_transmittance;  // of the nearest fragments, for explanations

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uint first = first_key();
    if (keys[first] == no_key) discard;
    float transmittance = 1.0;
    for (uint i = 0u; i < uint(SHEER_K) && keys[first + i] != no_key; ++i)
        transmittance *= transmittance_of(keys[first + i]);
    vec3 behind = texelFetch(u_opaque, pixel, 0).rgb;
#if SHEER_KEEPS_REST
    float let_through = texelFetch(u_rest_transmittance, pixel, 0).r;
    behind *= let_through;
#if SHEER_AVERAGES_REST
    vec4 rest = texelFetch(u_rest, pixel, 0);
    if (rest.a > 0.0) behind += (1.0 - let_through) * rest.rgb / rest.a;
#endif
#endif
    o_transmittance = transmittance;
    o_color = vec4(texelFetch(u_near, pixel, 0).rgb + transmittance * behind, 1.0);
}
