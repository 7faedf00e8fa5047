#pragma once
#include <vector>

#include "renderer/image/image.h"

namespace sheer {

/// LDR-FLIP of Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild, "FLIP: A Difference Evaluator for
/// Alternating Images" (HPG 2020), for an observer with 67 pixels per degree (0.7 m from a 0.7 m wide 4K display).
/// One value a pixel, rows from the top down, 0 (no visible difference) to 1; 8-bit sRGB in, borders replicated as in
/// NVIDIA's tool, with which it agrees within 0.0001. The pictures must have the same size. Symmetric in its arguments;
/// the result does not depend on `max_threads` (0: one per core).
std::vector<float> flip_map(const Image8& reference, const Image8& test, int max_threads = 0);

/// Red, green and blue of linear light in 0..1, rows from the top down.
struct LinearPicture {
    int width_px = 0;
    int height_px = 0;
    std::vector<float> rgb;  ///< width * height * 3

    const float* pixel(int x, int y) const { return &rgb[(std::size_t(y) * width_px + x) * 3]; }
};

/// The same of pictures that are not rounded.
std::vector<float> flip_map(const LinearPicture& reference, const LinearPicture& test, int max_threads = 0);

}  // namespace sheer
