// A sum of colors, divided by the sum of their weights, has the opacity that the product of the transmittances leaves.
uniform sampler2D u_opaque;
uniform sampler2D u_sum;
uniform sampler2D u_transmittance;

layout(location = 0) out vec4 o_color;  // no blending

const float least = 1e-30;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float transmittance = texelFetch(u_transmittance, pixel, 0).r;
    if (transmittance == 1.0) discard;
    vec4 sum = texelFetch(u_sum, pixel, 0);
    o_color = vec4(mix(sum.rgb / max(sum.a, least), texelFetch(u_opaque, pixel, 0).rgb, transmittance), 1.0);
}
