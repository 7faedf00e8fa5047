// A stand-in for a method's shader: a loop that takes long, then whatever the method does that may put the tests off.
// Set before: start(), cut(), and o_color, the output.
uniform int u_iterations;

void main() {
    float sum = start();
    for (int i = 0; i < u_iterations; ++i) sum += sin(gl_FragCoord.x * float(i));
    cut(sum);
    o_color = vec4(sum, 1.0, 1.0, 1.0);
}
