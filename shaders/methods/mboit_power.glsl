// From power moments. K(x, y) is v(x) B^-1 v(y) with v(x) = (1, x, ... x^h) and the Hankel matrix B of the moments. Set
// before: SHEER_MOMENTS, 4, 6 or 8.
const int half_count = SHEER_MOMENTS / 2, size = half_count + 1;
const int bisections = 26;

// What the bias mixes in.
#if SHEER_MOMENTS == 4
const float spread[5] = float[5](1.0, 0.0, 0.375, 0.0, 0.375);
#elif SHEER_MOMENTS == 6
const float spread[7] = float[7](1.0, 0.0, 0.48, 0.0, 0.451, 0.0, 0.45);
#else
const float spread[9] = float[9](1.0, 0.0, 0.75, 0.0, 0.67666666666666664, 0.0, 0.63, 0.0, 0.60030303030303034);
#endif

// B = L D L^T, with ones on L's diagonal.
float lower[size][size], diagonal[size];

void decompose(float moments[SHEER_MOMENTS + 1]) {
    for (int j = 0; j < size; ++j)
        for (int i = j; i < size; ++i) {
            float sum = moments[i + j];
            for (int k = 0; k < j; ++k) sum -= lower[i][k] * lower[j][k] * diagonal[k];
            if (i == j) {
                diagonal[j] = sum;
                lower[j][j] = 1.0;
            } else {
                lower[i][j] = sum / diagonal[j];
            }
        }
}

// L^-1 v(x)
float[size] forward(float x) {
    float result[size];
    float power = 1.0;
    for (int i = 0; i < size; ++i) {
        result[i] = power;
        for (int k = 0; k < i; ++k) result[i] -= lower[i][k] * result[k];
        power *= x;
    }
    return result;
}

float absorbance_at(float x) {
    float v[size] = forward(x);
    float sum = 0.0;
    for (int i = 0; i < size; ++i) sum += v[i] * v[i] / diagonal[i];
    return 1.0 / sum;
}

// The coefficients of K(z, x) as a polynomial in x.
float[size] kernel(float z) {
    float c[size] = forward(z);
    for (int i = 0; i < size; ++i) c[i] /= diagonal[i];
    for (int i = size - 1; i >= 0; --i)
        for (int k = i + 1; k < size; ++k) c[i] -= lower[k][i] * c[k];
    return c;
}

// The derivative of order `half_count - degree` of the polynomial at t / (1 - |t|), times (1 - |t|)^degree: finite for t from
// -1 to 1.
float derivative_at(float c[size], int degree, float t) {
    float rest = 1.0 - abs(t), sum = 0.0, power = 1.0;
    for (int i = degree; i >= 0; --i) {
        float factor = 1.0;
        for (int k = 0; k < half_count - degree; ++k) factor *= float(i + half_count - degree - k);
        sum = sum * t + factor * c[i + half_count - degree] * power;
        power *= rest;
    }
    return sum;
}

// All are real, and between them lie those of the derivative: found from one derivative to the next.
float[half_count] roots(float c[size]) {
    float found[half_count];
    for (int degree = 1; degree <= half_count; ++degree) {
        float last = -1.0, next[half_count];
        bool begins_negative = derivative_at(c, degree, -1.0) < 0.0;
        for (int i = 0; i < degree; ++i) {
            float low = last, high = i < degree - 1 ? found[i] : 1.0;
            last = high;
            bool rises = begins_negative == ((i & 1) == 0);
            for (int step = 0; step < bisections; ++step) {
                float middle = 0.5 * (low + high);
                if ((derivative_at(c, degree, middle) < 0.0) == rises) {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            next[i] = 0.5 * (low + high);
        }
        for (int i = 0; i < degree; ++i) found[i] = next[i];
    }
    for (int i = 0; i < half_count; ++i) found[i] /= max(1.0 - abs(found[i]), 1e-7);
    return found;
}

float before(float moments[SHEER_MOMENTS + 1], float depth) {
    float z = 2.0 * depth - 1.0;
    decompose(moments);
    float in_front = u_overestimation * absorbance_at(z);
    float places[half_count] = roots(kernel(z));
    for (int i = 0; i < half_count; ++i)
        if (places[i] < z) in_front += absorbance_at(places[i]);
    return in_front;
}
