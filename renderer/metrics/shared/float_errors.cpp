#include "renderer/metrics/shared/float_errors.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sheer {

void FloatErrors::add(const float* reference, const float* test, std::size_t pixels) {
    // A sum for each channel, of which alpha's is ignored at the end: four chains of additions instead of one.
    std::array<double, 4> absolutes{}, squares{}, maxima{};
    for (std::size_t i = 0; i < pixels; ++i, reference += 4, test += 4)
        for (std::size_t c = 0; c < 4; ++c) {
            const double absolute = std::abs(double{reference[c]} - double{test[c]});
            absolutes[c] += absolute;
            squares[c] += absolute * absolute;
            maxima[c] = maxima[c] < absolute ? absolute : maxima[c];
        }
    for (std::size_t c = 0; c < 3; ++c) {
        sum_of_absolutes += absolutes[c];
        sum_of_squares += squares[c];
        greatest = std::max(greatest, maxima[c]);
    }
    count += pixels * 3;
}

FloatErrors& FloatErrors::operator+=(const FloatErrors& other) {
    count += other.count;
    sum_of_absolutes += other.sum_of_absolutes;
    sum_of_squares += other.sum_of_squares;
    greatest = std::max(greatest, other.greatest);
    return *this;
}

bool FloatErrors::finite() const {
    return std::isfinite(sum_of_absolutes);
}

double FloatErrors::rmse() const {
    return std::sqrt(sum_of_squares / double(count));
}

FloatErrors float_errors(const Image& reference, const Image& test) {
    FloatErrors errors;
    errors.add(reference.rgba.data(), test.rgba.data(), reference.pixel_count());
    return errors;
}

}  // namespace sheer
