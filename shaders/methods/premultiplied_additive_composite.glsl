uniform sampler2D u_opaque;
uniform sampler2D u_sum;
uniform sampler2D u_transmittance;

layout(location = 0) out vec4 o_color;  // no blending

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 sum = texelFetch(u_sum, pixel, 0);
    float transmittance = texelFetch(u_transmittance, pixel, 0).r;
    if (sum.a == 0.0 && transmittance == 1.0) discard;
    o_color = vec4(clamp(sum.rgb + transmittance * texelFetch(u_opaque, pixel, 0).rgb, 0.0, 1.0), 1.0);
}
