#pragma once
#include <vector>

#include "renderer/metrics/shared/metric.h"

namespace sheer {

/// SSIM of each window that is wholly inside the picture, mean over red, green and blue.
struct SsimMap {
    int left = 0, top = 0;            ///< the first window's centre, px in the picture
    int width_px = 0, height_px = 0;  ///< windows in a row and in a column
    std::vector<float> values;        ///< rows from the top down
};

/// Wang, Bovik, Sheikh, Simoncelli: "Image Quality Assessment: From Error Visibility to Structural Similarity", IEEE
/// Transactions on Image Processing 13(4), 2004, equation 13: windows of 11x11 Gaussian weights (sigma 1.5), K1 = 0.01,
/// K2 = 0.03, range 255, no downsampling. A picture narrower than the window gets the widest odd window that fits, with
/// the weights scaled to sum to 1. The 8-bit pictures are compared.
SsimMap ssim_map(const ImagePair& pair);

}  // namespace sheer
