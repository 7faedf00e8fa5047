#include "renderer/metrics/float_errors.h"

#include <algorithm>
#include <cmath>

namespace sheer {

void FloatErrors::add(const float* reference, const float* test, std::size_t pixels) {
    for (std::size_t i = 0; i < pixels; ++i, reference += 4, test += 4)
        for (int c = 0; c < 3; ++c) {
            const double absolute = std::abs(double{reference[c]} - double{test[c]});
            sum_of_absolutes += absolute;
            sum_of_squares += absolute * absolute;
            greatest = std::max(greatest, absolute);
        }
    count += pixels * 3;
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
