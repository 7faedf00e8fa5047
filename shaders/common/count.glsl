layout(location = 0) out float o_count;  // blend ONE, ONE

void main() {
    o_count = 1.0;
}
