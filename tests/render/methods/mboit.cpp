#include "tests/render/method_row.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <map>
#include <memory>

namespace sheer::test {

namespace {

// The method in extended precision, by another way than the shader's: the roots are found together (Durand and Kerner),
// and the weights of the places are the means of Lagrange's polynomials.
using Real = long double;
using Complex = std::complex<Real>;
using Numbers = std::vector<Complex>;

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

struct MomentParameters {
    bool is_power;
    std::size_t moments;
    Real overestimation, bias;
    double greatest;

    std::size_t half() const { return moments / 2; }
    /// Moments of the place in the complex plane: the depth from -1 to 1, or a point of the unit circle.
    std::size_t highest() const { return is_power ? moments : half(); }
    Complex place_of(Real depth) const {
        return is_power ? Complex(2 * depth - 1) : std::polar(Real{1}, angle_of(depth));
    }
    static Real angle_of(Real depth) { return depth * 1.9L * pi; }
};

MomentParameters moment_parameters(const nlohmann::json& parameters) {
    const auto moments = parameters.value("moments", std::size_t{4});
    const bool is_power = parameters.value("kind", "power") == "power";
    const Real biases[2][3] = {{4e-7L, 8e-7L, 1.5e-6L}, {5e-7L, 5e-6L, 5e-5L}};
    return {is_power, moments, parameters.value("overestimation", 0.25),
            biases[is_power ? 1 : 0][moments / 2 - 2] * parameters.value("bias_scale", 1.0),
            parameters.value("greatest_absorbance", 10.0)};
}

/// Sums over the fragments of absorbance times a power of the place, from 0 up.
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

/// The same for pixels with the same fragments, of which a picture has many; each takes long.
template <typename Value>
std::function<Value(const Stack&)> remembered(const std::function<Value(const Stack&)>& compute) {
    const auto known = std::make_shared<std::map<std::vector<double>, Value>>();
    return [=](const Stack& stack) {
        std::vector<double> key(stack.below.begin(), stack.below.end());
        for (const Fragment& fragment : stack.fragments) {
            key.insert(key.end(), {fragment.depth, fragment.alpha});
            key.insert(key.end(), fragment.color.begin(), fragment.color.end());
        }
        const auto [place, is_new] = known->try_emplace(key);
        if (is_new) place->second = compute(stack);
        return place->second;
    };
}

/// How much the result changes if each moment is off by as much as its sum in 32-bit floats may be, up or down. That is
/// far more than a rounding where the moments are those of few layers, since then the matrix is nearly singular.
double change_by_rounding(const Stack& stack, const MomentParameters& of) {
    const Numbers sums = moment_sums(stack, of);
    if (sums[0] == Complex(0)) return 0;
    const Color exact = blended_by_moments(stack, sums, of);
    double sum = 0;
    for (std::size_t k = 1; k < sums.size(); ++k)
        for (const Complex& direction : {Complex(1), Complex(0, 1)}) {
            if (of.is_power && direction.imag() != 0) continue;
            Numbers off = sums;
            off[k] += direction * sums[0] * 0x1p-22L;
            const Color color = blended_by_moments(stack, off, of);
            double change = 0;
            for (std::size_t i = 0; i < 3; ++i) change = std::max(change, std::abs(color[i] - exact[i]));
            sum += std::isfinite(change) ? 2 * change : 1;
        }
    return sum;
}

Bound moments_bound(const nlohmann::json& parameters) {
    const auto change = remembered<double>(
        [of = moment_parameters(parameters)](const Stack& stack) { return change_by_rounding(stack, of); });
    return [=](const Stack& stack, PixelFormat format) {
        return std::min(1.0, 1e-5 + change(stack) + (format == PixelFormat::rgba32f ? 0 : 1.01 * step_of(format)));
    };
}

MethodVariant moments_variant(const nlohmann::json& parameters) {
    return {parameters, moments_bound(parameters), false, 64};
}

}  // namespace

MethodRow row_mboit() {
    return {
        .id = "mboit",
        .formula = [](const nlohmann::json& parameters) -> Formula {
            return remembered<Color>([of = moment_parameters(parameters)](const Stack& stack) {
                return blended_by_moments(stack, moment_sums(stack, of), of);
            });
        },
        .weighs_depths = true,
        .variants = {moments_variant(nlohmann::json::object()), moments_variant({{"overestimation", 0}}),
                     moments_variant({{"moments", 6}}), moments_variant({{"moments", 8}}),
                     moments_variant({{"kind", "trigonometric"}}),
                     moments_variant({{"kind", "trigonometric"}, {"moments", 6}}),
                     moments_variant({{"kind", "trigonometric"}, {"moments", 8}}),
                     moments_variant({{"bias_scale", 100}, {"greatest_absorbance", 3}})},
        .litmus =
            {{"",
              {nlohmann::json::object()},
              {{{"shuffled"}, passes, "moments are sums, which do not depend on the order, except for rounding"},
               {{"unequal"},
                fails,
                "a quarter of its own absorbance is taken to be in front of each layer, which makes a layer the "
                "fainter the higher its alpha is"},
               {{"window"},
                fails,
                "a quarter of an absorbance of 10 hides the leaf from itself, and the glass in front gets its weight"},
               {{"close_pair"},
                passes,
                "four moments suffice for three layers, however close, and with equal alphas each loses the same part "
                "to the overestimation"},
               {{"interleaved"}, fails, "four moments do not tell sixteen layers apart; the nearest shows too little"},
               {{"black", "white", "checker", "glass", "opaque_behind"},
                passes,
                "four moments suffice for three layers, and with equal alphas each loses the same part to the "
                "overestimation"},
               {{"alpha_to_0"}, passes, "faint layers hardly hide each other"},
               {{"alpha_to_1", "leaves"},
                passes,
                "an absorbance of 5 and more in front leaves nothing of the farther layers"},
               {{"opaque_front", "opaque_between"}, passes, "both passes are tested against the opaque depth"},
               {{"one_layer"}, passes, "one layer is its own mean, whatever its weight"},
               {{"64_layers"}, fails, "four moments do not show where red ends and blue begins"}}}},
        .litmus_tolerance = 2e-3,
    };
}

}  // namespace sheer::test
