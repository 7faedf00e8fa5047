// Enderton et al. 2010, section 3. Set before: common/hash.glsl, SHEER_SAMPLES, SHEER_STRATIFIED (0 or 1).
uniform uint u_seed;

// No blending; depth test and depth writes, per sample. Premultiplied by the coverage, which the sample mask is.
layout(location = 0) out vec4 o_color;

// With the primitive in the hash, layers of one pixel are independent.
float random(uint number) {
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    return unit_number(hashed(number, hashed(v_primitive, hashed(pixel.x, hashed(pixel.y, u_seed)))));
}

#if SHEER_STRATIFIED
// R = floor(alpha S + random) of the S samples, each set of R equally likely: going through the samples, each is taken
// with the probability of what is missing over what is left.
int mask(float alpha) {
    int missing = int(alpha * float(SHEER_SAMPLES) + random(uint(SHEER_SAMPLES))), samples = 0;
    for (int i = 0; i < SHEER_SAMPLES; ++i)
        if (random(uint(i)) * float(SHEER_SAMPLES - i) < float(missing)) {
            samples |= 1 << i;
            --missing;
        }
    return samples;
}
#else
int mask(float alpha) {
    int samples = 0;
    for (int i = 0; i < SHEER_SAMPLES; ++i)
        if (random(uint(i)) < alpha) samples |= 1 << i;
    return samples;
}
#endif

void main() {
    begin_fragment();
    vec4 work = clamp(real_work(v_uv, v_tint), 0.0, 1.0);
    int samples = mask(work.a);
    if (samples == 0) discard;
    gl_SampleMask[0] = samples;
    o_color = vec4(work.rgb, 1.0);
}
