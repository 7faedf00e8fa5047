// The Haar basis over the depths 0 to 1 with SHEER_COEFFICIENTS functions, a power of 2: number 0 is 1 everywhere; of the
// others, 2^l are on level l, each on a part of 2^-l: +sqrt(2^l) on its first half, -sqrt(2^l) on its second.
// Set before: SHEER_COEFFICIENTS.

// So that the farthest depth still has a cell behind its own: Aizenshtein et al. 2022.
float scaled_depth() { return gl_FragCoord.z * float(SHEER_COEFFICIENTS - 1) / float(SHEER_COEFFICIENTS); }
