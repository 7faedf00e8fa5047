uniform sampler2D u_opaque;
uniform sampler2D u_near;  // color and transmittance
uniform sampler2D u_far;   // premultiplied

layout(location = 0) out vec4 o_color;  // no blending: the target's rounding is the only one

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 near = texelFetch(u_near, pixel, 0), far = texelFetch(u_far, pixel, 0);
    vec3 behind = far.rgb + (1.0 - far.a) * texelFetch(u_opaque, pixel, 0).rgb;
    o_color = vec4(near.rgb + near.a * behind, 1.0);
}
