// A stand-in for a method's shader: a long loop, then what the method does that may delay the tests.
// Set before: start(), cut(), and o_color, the output.
uniform int u_iterations;

void main() {
    float sum = start();
    for (int i = 0; i < u_iterations; ++i) sum += sin(gl_FragCoord.x * float(i));
    cut(sum);
    o_color = vec4(sum, 1.0, 1.0, 1.0);
}
