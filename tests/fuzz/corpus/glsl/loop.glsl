const int n = 3;
vec4 sum = vec4(0);
for (int i = 0; i < n; ++i) { // comment
    sum += sample_texture(uv * float(i)) / float(n);
}
return sum * tint;
