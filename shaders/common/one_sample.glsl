// One sample of each pixel.
uniform sampler2DMS u_color;
uniform sampler2DMS u_depth;

uniform int u_sample;

layout(location = 0) out vec4 o_color;  // no blending
layout(location = 1) out float o_depth;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    o_color = texelFetch(u_color, pixel, u_sample);
    o_depth = texelFetch(u_depth, pixel, u_sample).r;
}
