// The depth goes around a circle, but for a gap between far and near.
const float circle = 6.283185307179586, gap = 0.1 * 3.141592653589793;

float angle_of(float depth) { return depth * (circle - gap); }

// The length must be 1 to within a rounding: the bias is hardly more than that, and sines are less exact on some devices.
vec2 on_circle(float angle) {
    vec2 place = vec2(cos(angle), sin(angle));
    return place / length(place);
}

vec2 times(vec2 a, vec2 b) { return vec2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x); }
