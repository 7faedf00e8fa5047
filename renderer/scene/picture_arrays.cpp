#include "renderer/scene/picture_arrays.h"

#include <algorithm>
#include <optional>

namespace sheer {

namespace {

using glm::ivec2;
using Sizes = std::vector<ivec2>;

std::size_t area(const ivec2& size) {
    return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
}

ivec2 halved(const ivec2& size) {
    return glm::max(size / 2, ivec2(1));
}

/// The mipmap level of `size` in a texture of `whole`, if it is one of its levels.
std::optional<int> level_of(const ivec2& size, ivec2 whole) {
    for (int level = 0;; ++level) {
        if (whole == size) return level;
        if (whole == ivec2(1)) return std::nullopt;
        whole = halved(whole);
    }
}

bool smaller(const ivec2& a, const ivec2& b) {
    return area(a) != area(b) ? area(a) < area(b) : a.x < b.x;
}

/// Every size once, small to large.
Sizes distinct(Sizes sizes) {
    std::ranges::sort(sizes, smaller);
    sizes.erase(std::ranges::unique(sizes).begin(), sizes.end());
    return sizes;
}

/// The sizes of the arrays, reduced until they are few enough. Sizes that are a mipmap level of a larger one are
/// dropped first; if there are still too many, the smallest of the others are scaled, in `sizes`.
Sizes array_sizes(Sizes& sizes) {
    Sizes arrays = distinct(sizes);
    for (std::size_t i = 0; i < arrays.size() && arrays.size() > max_picture_arrays;) {
        const bool within = std::any_of(arrays.begin() + static_cast<std::ptrdiff_t>(i) + 1, arrays.end(),
                                        [&](const ivec2& whole) { return level_of(arrays[i], whole).has_value(); });
        if (within) {
            arrays.erase(arrays.begin() + static_cast<std::ptrdiff_t>(i));
        } else {
            ++i;
        }
    }
    while (arrays.size() > max_picture_arrays) {
        const ivec2 next = arrays[1];
        for (ivec2& size : sizes)
            if (level_of(size, arrays[0]) && std::none_of(arrays.begin() + 1, arrays.end(), [&](const ivec2& whole) {
                    return level_of(size, whole).has_value();
                }))
                size = next;
        arrays.erase(arrays.begin());
    }
    return arrays;
}

PictureArrays placed(Sizes sizes) {
    PictureArrays arranged;
    for (const ivec2& size : array_sizes(sizes)) arranged.arrays.push_back({size, 0});
    for (const ivec2& size : sizes) {
        PictureArrays::Place place;
        // The arrays are ordered from small to large, so that the first one that fits wastes least.
        for (std::size_t array = 0; array < arranged.arrays.size(); ++array)
            if (const auto level = level_of(size, arranged.arrays[array].size_px)) {
                place = {static_cast<int>(array), arranged.arrays[array].layers++, *level};
                break;
            }
        arranged.places.push_back(place);
    }
    arranged.sizes_px = std::move(sizes);
    return arranged;
}

}  // namespace

PictureArrays arrange_pictures(Sizes sizes) {
    for (ivec2& size : sizes)
        while (std::max(size.x, size.y) > max_model_picture_side_px) size = halved(size);
    while (true) {
        PictureArrays arranged = placed(sizes);
        std::size_t texels = 0;
        for (const PictureArrays::Array& array : arranged.arrays)
            texels += area(array.size_px) * static_cast<std::size_t>(array.layers);
        if (texels <= max_model_texels || sizes.empty()) return arranged;
        sizes = arranged.sizes_px;
        const std::size_t largest = area(*std::ranges::max_element(sizes, smaller));
        for (ivec2& size : sizes)
            if (area(size) > largest / 2) size = halved(size);
    }
}

}  // namespace sheer
