// Set before: SHEER_SAMPLES.
uniform sampler2DMS u_samples;

layout(location = 0) out vec4 o_sum;  // blend ONE, ONE

void main() {
    vec4 sum = vec4(0.0);
    for (int i = 0; i < SHEER_SAMPLES; ++i) sum += texelFetch(u_samples, ivec2(gl_FragCoord.xy), i);
    o_sum = sum;
}
