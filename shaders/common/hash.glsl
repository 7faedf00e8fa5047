// PCG, a hash whose bits are evenly distributed: Jarzynski and Olano, Hash Functions for GPU Rendering, JCGT 9(3), 2020.
uint hashed(uint value) {
    uint state = value * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

uint hashed(uint a, uint b) { return hashed(a + hashed(b)); }

// 0 to 1, without 1.
float unit_number(uint hash) { return float(hash >> 8) / 16777216.0; }
