#pragma once
#include <vector>

namespace sheer {

/// The worst part of a picture, whose errors the mean over all of it may hide.
inline constexpr int worst_tile_px = 64;

struct WorstTile {
    double mean = 0;
    int x = 0, y = 0;  ///< its top left pixel
};

/// Of a map with a value for each pixel, rows from the top down: the tile of 64x64 pixels with the greatest mean, the
/// first in row order of several. The tiles lie side by side from the top left; the last of a row or column is moved so
/// far back that it lies within. A side that is shorter than a tile has one of that length.
WorstTile greatest_tile(const std::vector<float>& map, int width_px, int height_px);
/// The one with the least mean.
WorstTile least_tile(const std::vector<float>& map, int width_px, int height_px);

}  // namespace sheer
