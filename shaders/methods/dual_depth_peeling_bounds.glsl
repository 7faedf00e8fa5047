layout(location = 0) out vec2 o_bounds;  // blend equation MAX

void main() {
    o_bounds = vec2(-gl_FragCoord.z, gl_FragCoord.z);
}
