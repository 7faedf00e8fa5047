// Lays a front-to-back accumulation (premultiplied color, transmittance) over the opaque picture, both in 32-bit
// floats: SCCG 2010, section 2, with the target's rounding as the only one.
uniform sampler2D u_opaque;
uniform sampler2D u_accumulation;

layout(location = 0) out vec4 o_color;  // no blending

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 accumulation = texelFetch(u_accumulation, pixel, 0);
    o_color = vec4(accumulation.rgb + accumulation.a * texelFetch(u_opaque, pixel, 0).rgb, 1.0);
}
