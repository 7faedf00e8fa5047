// No color output; depth test LESS with depth writes.
void main() {}
