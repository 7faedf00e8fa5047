// No output: the stencil operation of a failed depth test is all that this pass is for.
void main() {}
