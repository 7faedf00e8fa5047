// From trigonometric moments, the means of e^(i k phi). The depth goes around a circle, but for a gap between far and near.
// K(phi, psi) is v(psi)* B^-1 v(phi) with v(phi) = (1, e^(i phi), ... e^(i h phi)) and the Toeplitz matrix B of the moments.
// Set before: mboit_circle.glsl; SHEER_MOMENTS, 4, 6 or 8, which counts real and imaginary parts.
const int half_count = SHEER_MOMENTS / 2, size = half_count + 1;
const int bisections = 26;

// What the bias mixes in.
const float spread[SHEER_MOMENTS + 1] = float[SHEER_MOMENTS + 1](1.0, 0.0, 0.0, 0.0, 0.0
#if SHEER_MOMENTS > 4
                                                                 , 0.0, 0.0
#endif
#if SHEER_MOMENTS > 6
                                                                 , 0.0, 0.0
#endif
);

vec2 conjugate(vec2 a) { return vec2(a.x, -a.y); }

// B = L D L*, with ones on L's diagonal. Its upper left parts are those of B.
vec2 lower[size][size];
float diagonal[size];

void decompose(float moments[SHEER_MOMENTS + 1]) {
    for (int j = 0; j < size; ++j)
        for (int i = j; i < size; ++i) {
            vec2 sum = i == j ? vec2(1.0, 0.0) : vec2(moments[2 * (i - j) - 1], moments[2 * (i - j)]);
            for (int k = 0; k < j; ++k) sum -= diagonal[k] * times(lower[i][k], conjugate(lower[j][k]));
            if (i == j) {
                diagonal[j] = sum.x;
            } else {
                lower[i][j] = sum / diagonal[j];
            }
        }
}

// L^-1 v(angle)
vec2[size] forward(float angle) {
    vec2 result[size];
    vec2 step = on_circle(angle), power = vec2(1.0, 0.0);
    for (int i = 0; i < size; ++i) {
        result[i] = power;
        for (int k = 0; k < i; ++k) result[i] -= times(lower[i][k], result[k]);
        power = times(power, step);
    }
    return result;
}

float absorbance_at(float angle) {
    vec2 v[size] = forward(angle);
    float sum = 0.0;
    for (int i = 0; i < size; ++i) sum += dot(v[i], v[i]) / diagonal[i];
    return 1.0 / sum;
}

// The kernel of the first `degree` moments between two angles, turned so that it is real.
float kernel(vec2 own[size], float own_angle, int degree, float angle) {
    vec2 other[size] = forward(angle), sum = vec2(0.0);
    for (int i = 0; i <= degree; ++i) sum += times(conjugate(other[i]), own[i]) / diagonal[i];
    return times(sum, on_circle(0.5 * float(degree) * (angle - own_angle))).x;
}

// Once around the circle from the own angle, there are as many roots as moments, and between them lie those for one moment
// less: found from one degree to the next. The sign changes at each, which is surer than the sign at the last root: of few
// layers, the roots of two degrees are the same.
float[half_count] roots(float own_angle) {
    vec2 own[size] = forward(own_angle);
    float found[half_count];
    for (int degree = 1; degree <= half_count; ++degree) {
        float last = own_angle, next[half_count];
        for (int i = 0; i < degree; ++i) {
            float low = last, high = i < degree - 1 ? found[i] : own_angle + circle;
            last = high;
            bool is_positive = (i & 1) == 0;
            for (int step = 0; step < bisections; ++step) {
                float middle = 0.5 * (low + high);
                if ((kernel(own, own_angle, degree, middle) > 0.0) == is_positive) {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            next[i] = 0.5 * (low + high);
        }
        for (int i = 0; i < degree; ++i) found[i] = next[i];
    }
    return found;
}

// What lies in the gap counts as near the closer it is to the near end.
float before(float moments[SHEER_MOMENTS + 1], float depth) {
    float own_angle = angle_of(depth);
    decompose(moments);
    float in_front = u_overestimation * absorbance_at(own_angle);
    float angles[half_count] = roots(own_angle);
    for (int i = 0; i < half_count; ++i) {
        float angle = angles[i] < circle ? angles[i] : angles[i] - circle;
        float weight = angle < own_angle ? 1.0 : clamp((angle - circle) / gap + 1.0, 0.0, 1.0);
        in_front += weight * absorbance_at(angle);
    }
    return in_front;
}
