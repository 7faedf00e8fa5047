// Lays a front-to-back accumulation (premultiplied color, transmittance) over what is there: SCCG 2010, section 2.
uniform sampler2D u_accumulation;

layout(location = 0) out vec4 o_color;  // blend ONE, SRC_ALPHA for color; ZERO, ONE for alpha

void main() {
    o_color = texelFetch(u_accumulation, ivec2(gl_FragCoord.xy), 0);
}
