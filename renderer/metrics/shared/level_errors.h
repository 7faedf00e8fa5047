#pragma once
#include <cstdint>

#include "renderer/image/image.h"

namespace sheer {

/// Differences of 8-bit levels, reference minus test, over the red, green and blue of all pixels. Exact: whole numbers.
struct LevelErrors {
    std::uint64_t count = 0;  ///< channels of all pixels
    std::uint64_t sum_of_absolutes = 0;
    std::uint64_t sum_of_squares = 0;
    int min = 0;  ///< -255..255
    int max = 0;

    /// Of the pictures' values in 0..1.
    double mean_square() const { return double(sum_of_squares) / (double(count) * 255 * 255); }
};

/// The pictures must have the same size and at least one pixel.
LevelErrors level_errors(const Image8& reference, const Image8& test);

}  // namespace sheer
