// Set before: SHEER_NODES.
uniform sampler2D u_opaque;
uniform sampler2D u_node_0, u_node_1, u_node_2, u_node_3, u_node_4, u_node_5;

layout(location = 0) out vec4 o_color;  // no blending

vec3 color = vec3(0.0);
float transmittance = 1.0;

void add(sampler2D nodes) {
    vec4 node = texelFetch(nodes, ivec2(gl_FragCoord.xy), 0);
    color += transmittance * node.rgb;
    transmittance *= node.a;
}

void main() {
    add(u_node_0);
    add(u_node_1);
#if SHEER_NODES > 2
    add(u_node_2);
#endif
#if SHEER_NODES > 3
    add(u_node_3);
#endif
#if SHEER_NODES > 4
    add(u_node_4);
#endif
#if SHEER_NODES > 5
    add(u_node_5);
#endif
    if (transmittance == 1.0) discard;
    o_color = vec4(color + transmittance * texelFetch(u_opaque, ivec2(gl_FragCoord.xy), 0).rgb, 1.0);
}
