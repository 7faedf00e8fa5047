#include "renderer/image/pixel_counts.h"

#include <algorithm>

#include "renderer/image/magma.h"

namespace sheer {

std::uint64_t PixelCounts::total() const {
    return total_in(0, 0, width_px, height_px);
}

std::uint32_t PixelCounts::greatest() const {
    return counts.empty() ? 0 : *std::ranges::max_element(counts);
}

std::uint64_t PixelCounts::total_in(int x0, int y0, int x1, int y1) const {
    std::uint64_t sum = 0;
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) sum += counts[static_cast<std::size_t>(y) * width_px + x];
    return sum;
}

Image8 count_picture(const PixelCounts& counts, std::uint32_t full_scale) {
    Image8 picture(counts.width_px, counts.height_px);
    const std::uint64_t scale = std::max(full_scale, 1u);
    for (std::size_t i = 0; i < counts.counts.size(); ++i) {
        const std::uint64_t level = std::min<std::uint64_t>((counts.counts[i] * 255ull + scale / 2) / scale, 255);
        std::ranges::copy(magma()[level], picture.rgb.begin() + static_cast<std::ptrdiff_t>(3 * i));
    }
    return picture;
}

}  // namespace sheer
