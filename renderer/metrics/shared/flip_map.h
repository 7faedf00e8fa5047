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

}  // namespace sheer
