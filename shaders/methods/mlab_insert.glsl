// Salvi and Vaidyanathan 2014, section 3. Set before: SHEER_NODES, 2 to 6. A node is a premultiplied color and a
// transmittance; those that are empty are behind all others. Each fragment reads and replaces all of its pixel.
layout(location = 0) inout vec4 o_node_0;  // no blending
layout(location = 1) inout vec4 o_node_1;
#if SHEER_NODES > 2
layout(location = 2) inout vec4 o_node_2;
#endif
#if SHEER_NODES > 3
layout(location = 3) inout vec4 o_node_3;
#endif
#if SHEER_NODES > 4
layout(location = 4) inout vec4 o_node_4;
#endif
#if SHEER_NODES > 5
layout(location = 5) inout vec4 o_node_5;
#endif
layout(location = SHEER_NODES) inout vec4 o_depths_0;
#if SHEER_NODES > 4
layout(location = SHEER_NODES + 1) inout vec4 o_depths_1;
#endif

const float empty = 2.0;

// What is in front stays, what is behind is passed on. Of equal depths the one submitted later is in front.
void put(inout vec4 node, inout float depth, inout vec4 passed_on, inout float passed_on_depth) {
    if (passed_on_depth > depth) return;
    vec4 behind = node;
    float depth_behind = depth;
    node = passed_on;
    depth = passed_on_depth;
    passed_on = behind;
    passed_on_depth = depth_behind;
}

// The last node takes what finds no room, as if it were directly behind it.
void merge(inout vec4 node, vec4 behind) {
    node.rgb += node.a * behind.rgb;
    node.a *= behind.a;
}

void main() {
    begin_fragment();
    vec4 work = clamp(real_work(v_uv, v_tint), 0.0, 1.0);
    if (work.a == 0.0) discard;
    vec4 fragment = vec4(work.rgb * work.a, 1.0 - work.a);
    float depth = gl_FragCoord.z;
    vec4 node_0 = o_node_0, node_1 = o_node_1, depths_0 = o_depths_0;
    put(node_0, depths_0.x, fragment, depth);
    put(node_1, depths_0.y, fragment, depth);
#if SHEER_NODES > 2
    vec4 node_2 = o_node_2;
    put(node_2, depths_0.z, fragment, depth);
#endif
#if SHEER_NODES > 3
    vec4 node_3 = o_node_3;
    put(node_3, depths_0.w, fragment, depth);
#endif
#if SHEER_NODES > 4
    vec4 node_4 = o_node_4, depths_1 = o_depths_1;
    put(node_4, depths_1.x, fragment, depth);
#endif
#if SHEER_NODES > 5
    vec4 node_5 = o_node_5;
    put(node_5, depths_1.y, fragment, depth);
#endif
    if (depth < empty) {
#if SHEER_NODES == 2
        merge(node_1, fragment);
#elif SHEER_NODES == 3
        merge(node_2, fragment);
#elif SHEER_NODES == 4
        merge(node_3, fragment);
#elif SHEER_NODES == 5
        merge(node_4, fragment);
#else
        merge(node_5, fragment);
#endif
    }
    o_node_0 = node_0;
    o_node_1 = node_1;
    o_depths_0 = depths_0;
#if SHEER_NODES > 2
    o_node_2 = node_2;
#endif
#if SHEER_NODES > 3
    o_node_3 = node_3;
#endif
#if SHEER_NODES > 4
    o_node_4 = node_4;
    o_depths_1 = depths_1;
#endif
#if SHEER_NODES > 5
    o_node_5 = node_5;
#endif
}
