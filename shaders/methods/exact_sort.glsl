// Bottom-up merge sort of a linked list: `u_merges` rounds, in which runs of u_run, 2 u_run, ... nodes are merged in pairs.
uniform uint u_run;
uniform int u_merges;

// No color output: the color mask is off.
void main() {
    // A device's helpers beyond the last row or column would follow a list that another pixel is sorting.
    if (gl_HelperInvocation) return;
    uint pixel = pixel_number();
    uint head = heads[pixel];
    uint run = u_run;
    for (int merge = 0; merge < u_merges; ++merge) {
        uint left = head, tail = 0u;
        uint pairs = 0u;
        head = 0u;
        while (left != 0u) {
            ++pairs;
            uint right = left, left_size = 0u, right_size = run;
            while (left_size < run && right != 0u) {
                ++left_size;
                right = next_of(right);
            }
            while (left_size > 0u || (right_size > 0u && right != 0u)) {
                bool take_left = left_size > 0u && (right_size == 0u || right == 0u || goes_before(left, right));
                uint taken = take_left ? left : right;
                if (take_left) {
                    left = next_of(left);
                    --left_size;
                } else {
                    right = next_of(right);
                    --right_size;
                }
                if (tail == 0u) {
                    head = taken;
                } else {
                    set_next(tail, taken);
                }
                tail = taken;
            }
            left = right;
        }
        if (tail != 0u) set_next(tail, 0u);
        if (pairs <= 1u) break;
        run *= 2u;
    }
    heads[pixel] = head;
}
