uniform sampler2D u_color;

uniform float u_factor;

layout(location = 0) out vec4 o_color;  // no blending, or ONE, ONE

void main() {
    o_color = u_factor * texelFetch(u_color, ivec2(gl_FragCoord.xy), 0);
}
