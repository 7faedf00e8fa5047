#include "renderer/metrics/shared/level_errors.h"

#include <algorithm>
#include <cstdlib>

namespace sheer {

LevelErrors level_errors(const Image8& reference, const Image8& test) {
    LevelErrors errors;
    errors.count = reference.rgb.size();
    errors.min = 255;
    errors.max = -255;
    // In pieces whose sums fit 32 bits: 255^2 * 4096 < 2^32.
    constexpr std::size_t at_once = 4096;
    for (std::size_t first = 0; first < errors.count; first += at_once) {
        const std::size_t end = std::min<std::size_t>(first + at_once, errors.count);
        std::uint32_t absolutes = 0, squares = 0;
        for (std::size_t i = first; i < end; ++i) {
            const int difference = int(reference.rgb[i]) - int(test.rgb[i]);
            absolutes += std::uint32_t(std::abs(difference));
            squares += std::uint32_t(difference * difference);
            errors.min = std::min(errors.min, difference);
            errors.max = std::max(errors.max, difference);
        }
        errors.sum_of_absolutes += absolutes;
        errors.sum_of_squares += squares;
    }
    return errors;
}

}  // namespace sheer
