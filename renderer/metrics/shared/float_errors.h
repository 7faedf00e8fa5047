#pragma once
#include <cstddef>
#include <cstdint>

#include "renderer/image/image.h"

namespace sheer {

/// Differences over red, green and blue of float pictures as they are, neither clamped nor rounded. Summed in doubles.
struct FloatErrors {
    std::uint64_t count = 0;  ///< channels of all pixels
    double sum_of_absolutes = 0;
    double sum_of_squares = 0;
    double greatest = 0;  ///< absolute

    /// `pixels` pixels of 4 floats each.
    void add(const float* reference, const float* test, std::size_t pixels);
    FloatErrors& operator+=(const FloatErrors& other);
    /// False if a NaN or an infinity was among them: the sums are then meaningless.
    bool finite() const;
    double mean_abs() const { return sum_of_absolutes / double(count); }
    double rmse() const;
};

/// For whole pictures of one size with at least one pixel.
FloatErrors float_errors(const Image& reference, const Image& test);

}  // namespace sheer
