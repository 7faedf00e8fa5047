#pragma once
#include <complex>
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "renderer/litmus/formula.h"

namespace sheer::litmus {

// The method in extended precision, by another way than the shader's: the roots are found together (Durand and Kerner),
// and the weights of the places are the means of Lagrange's polynomials.
using Real = long double;
using Complex = std::complex<Real>;
using Numbers = std::vector<Complex>;

struct MomentParameters {
    bool is_power;
    std::size_t moments;
    Real overestimation, bias;
    double greatest;
    bool is_half;  ///< summed in half floats, whose rounding the formula does not have

    std::size_t half() const { return moments / 2; }
    /// Moments of the place in the complex plane: the depth from -1 to 1, or a point of the unit circle.
    std::size_t highest() const { return is_power ? moments : half(); }
    Complex place_of(Real depth) const {
        return is_power ? Complex(2 * depth - 1) : std::polar(Real{1}, angle_of(depth));
    }
    static Real angle_of(Real depth) { return depth * 1.9L * 3.14159265358979323846L; }
};

MomentParameters moment_parameters(const nlohmann::json& parameters);

/// Sums over the fragments of absorbance times a power of the place, from 0 up.
Numbers moment_sums(const Stack& stack, const MomentParameters& of);

/// The pixel if its moments are these sums.
Color blended_by_moments(const Stack& stack, const Numbers& sums, const MomentParameters& of);

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

}  // namespace sheer::litmus
