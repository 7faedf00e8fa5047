// No colour output; depth test LESS with depth writes.
void main() {}
