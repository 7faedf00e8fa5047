#include "renderer/litmus/formulas/mboit.h"

#include <algorithm>
#include <cmath>

namespace sheer::litmus {

namespace {

constexpr Real pi = 3.14159265358979323846L;

/// Gaussian elimination with pivoting.
Numbers solved(std::vector<Numbers> matrix, Numbers right) {
    const std::size_t n = right.size();
    for (std::size_t column = 0; column < n; ++column) {
        std::size_t pivot = column;
        for (std::size_t row = column; row < n; ++row)
            if (std::abs(matrix[row][column]) > std::abs(matrix[pivot][column])) pivot = row;
        std::swap(matrix[column], matrix[pivot]);
        std::swap(right[column], right[pivot]);
        for (std::size_t row = column + 1; row < n; ++row) {
            const Complex factor = matrix[row][column] / matrix[column][column];
            for (std::size_t k = column; k < n; ++k) matrix[row][k] -= factor * matrix[column][k];
            right[row] -= factor * right[column];
        }
    }
    for (std::size_t row = n; row-- > 0;) {
        for (std::size_t k = row + 1; k < n; ++k) right[row] -= matrix[row][k] * right[k];
        right[row] /= matrix[row][row];
    }
    return right;
}

/// The roots of a polynomial, lowest coefficient first.
Numbers roots_of(const Numbers& polynomial) {
    const std::size_t degree = polynomial.size() - 1;
    Real radius = 0;
    for (std::size_t i = 0; i < degree; ++i)
        radius =
            std::max(radius, std::pow(std::abs(polynomial[i] / polynomial[degree]), 1 / static_cast<Real>(degree - i)));
    Numbers roots;
    for (std::size_t i = 0; i < degree; ++i)
        roots.push_back(std::polar(radius, 0.4L + 2 * pi * static_cast<Real>(i) / static_cast<Real>(degree)));
    Real moved = radius;
    for (int step = 0; step < 100 && moved > 1e-17L * radius; ++step) {
        moved = 0;
        for (std::size_t i = 0; i < degree; ++i) {
            Complex value = 0, others = polynomial[degree];
            for (std::size_t k = degree + 1; k-- > 0;) value = value * roots[i] + polynomial[k];
            for (std::size_t k = 0; k < degree; ++k)
                if (k != i) others *= roots[i] - roots[k];
            if (others == Complex(0)) continue;
            roots[i] -= value / others;
            moved = std::max(moved, std::abs(value / others));
        }
    }
    return roots;
}

/// The part of the absorbance at the place `which`: the mean of the polynomial that is 1 there and 0 at the others.
Real weight_at(const Numbers& places, std::size_t which, const Numbers& moments) {
    Numbers polynomial = {1};
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (i == which) continue;
        Numbers next(polynomial.size() + 1);
        const Complex scale = places[which] - places[i];
        for (std::size_t k = 0; k < polynomial.size(); ++k) {
            next[k + 1] += polynomial[k] / scale;
            next[k] -= polynomial[k] * places[i] / scale;
        }
        polynomial = next;
    }
    Complex sum = 0;
    for (std::size_t k = 0; k < polynomial.size(); ++k) sum += polynomial[k] * moments[k];
    return sum.real();
}

/// How much of what is at `place` counts as in front of a fragment of this depth. On the circle, what is in the gap
/// between far and near counts as near the closer it is to the near end.
Real part_in_front(const Complex& place, Real depth, const MomentParameters& of) {
    if (of.is_power) return place.real() < 2 * depth - 1 ? 1 : 0;
    const Real angle = std::arg(place) < 0 ? std::arg(place) + 2 * pi : std::arg(place);
    return angle < of.angle_of(depth) ? 1 : std::clamp((angle - 1.9L * pi) / (0.1L * pi), Real{0}, Real{1});
}

Real transmittance_before(Real depth, const Numbers& sums, const MomentParameters& of) {
    // The moments that the authors' bias mixes in.
    static const std::vector<Numbers> spreads = {
        {1, 0, 0.375L, 0, 0.375L},
        {1, 0, 0.48L, 0, 0.451L, 0, 0.45L},
        {1, 0, 0.75L, 0, 0.67666666666666664L, 0, 0.63L, 0, 0.60030303030303034L}};
    const Numbers none = {1, 0, 0, 0, 0};
    const Numbers& spread = of.is_power ? spreads[of.half() - 2] : none;
    const std::size_t size = of.half() + 1;
    const Complex own = of.place_of(depth);
    Numbers moments(sums.size()), powers;
    for (std::size_t k = 0; k < sums.size(); ++k) moments[k] = (1 - of.bias) * sums[k] / sums[0] + of.bias * spread[k];
    std::vector<Numbers> matrix(size, Numbers(size));
    Complex power = 1;
    for (std::size_t i = 0; i < size; ++i) {
        powers.push_back(power);
        power *= own;
        for (std::size_t k = 0; k < size; ++k)
            matrix[i][k] = of.is_power ? moments[i + k] : i >= k ? moments[i - k] : std::conj(moments[k - i]);
    }
    Numbers places = roots_of(solved(matrix, powers));
    if (!of.is_power)
        for (Complex& place : places) place = std::conj(place);
    places.push_back(own);
    Real in_front = 0;
    for (std::size_t i = 0; i < places.size(); ++i)
        in_front += weight_at(places, i, moments) *
                    (i + 1 == places.size() ? of.overestimation : part_in_front(places[i], depth, of));
    return std::clamp(std::exp(-sums[0].real() * in_front), Real{0}, Real{1});
}

}  // namespace

MomentParameters moment_parameters(const nlohmann::json& parameters) {
    const auto moments = parameters.value("moments", std::size_t{4});
    const bool is_power = parameters.value("kind", "power") == "power";
    const bool is_half = parameters.value("precision", "float32") == "float16";
    const Real biases[2][2][3] = {{{4e-7L, 8e-7L, 1.5e-6L}, {5e-7L, 5e-6L, 5e-5L}},
                                  {{4e-4L, 6.5e-4L, 8.5e-4L}, {6e-5L, 6e-4L, 2.5e-3L}}};
    return {is_power,
            moments,
            parameters.value("overestimation", 0.25),
            biases[is_half ? 1 : 0][is_power ? 1 : 0][moments / 2 - 2] * parameters.value("bias_scale", 1.0),
            parameters.value("greatest_absorbance", 10.0),
            is_half};
}

Numbers moment_sums(const Stack& stack, const MomentParameters& of) {
    Numbers sums(of.highest() + 1);
    for (const Fragment& fragment : stack.fragments) {
        Complex power = fragment.alpha < 1 ? std::min(of.greatest, -std::log1p(-fragment.alpha)) : of.greatest;
        for (Complex& sum : sums) {
            sum += power;
            power *= of.place_of(fragment.depth);
        }
    }
    return sums;
}

Color blended_by_moments(const Stack& stack, const Numbers& sums, const MomentParameters& of) {
    if (sums[0] == Complex(0)) return stack.below;
    Color sum = {};
    double weights = 0, transmittance = 1;
    for (const Fragment& fragment : stack.fragments) {
        transmittance *= 1 - fragment.alpha;
        if (fragment.alpha == 0) continue;
        const auto weight = static_cast<double>(fragment.alpha * transmittance_before(fragment.depth, sums, of));
        weights += weight;
        for (std::size_t i = 0; i < 3; ++i) sum[i] += weight * fragment.color[i];
    }
    for (double& channel : sum) channel /= weights;
    return mix(sum, stack.below, transmittance);
}

FormulaInfo formula_mboit() {
    std::vector<nlohmann::json> variants;
    for (const char* kind : {"power", "trigonometric"})
        for (const int moments : {4, 6, 8}) variants.push_back({{"kind", kind}, {"moments", moments}});
    variants.push_back({{"overestimation", 0}});
    return {.id = "mboit",
            .name = "moment-based transparency",
            .make = [](const nlohmann::json& parameters) -> Formula {
                return remembered<Color>([of = moment_parameters(parameters)](const Stack& stack) {
                    return blended_by_moments(stack, moment_sums(stack, of), of);
                });
            },
            .variants = variants};
}

}  // namespace sheer::litmus
