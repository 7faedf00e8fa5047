#include "renderer/metrics/shared/worst_tile.h"

#include <algorithm>
#include <numeric>

namespace sheer {
namespace {

/// Where the tiles along a side begin.
std::vector<int> places(int side_px, int tile_px) {
    std::vector<int> all;
    for (int at = 0; at < side_px; at += tile_px) all.push_back(std::min(at, side_px - tile_px));
    return all;
}

/// The one whose mean, times `sign`, is greatest.
WorstTile worst(const std::vector<float>& map, int width_px, int height_px, double sign) {
    const int across = std::min(worst_tile_px, width_px), down = std::min(worst_tile_px, height_px);
    WorstTile worst;
    bool is_first = true;
    for (const int top : places(height_px, down))
        for (const int left : places(width_px, across)) {
            double sum = 0;
            for (int y = top; y < top + down; ++y) {
                const auto row = map.begin() + std::ptrdiff_t(y) * width_px + left;
                sum = std::accumulate(row, row + across, sum);
            }
            const double mean = sum / (double(across) * down);
            if (!is_first && sign * mean <= sign * worst.mean) continue;
            worst = {mean, left, top};
            is_first = false;
        }
    return worst;
}

}  // namespace

WorstTile greatest_tile(const std::vector<float>& map, int width_px, int height_px) {
    return worst(map, width_px, height_px, 1);
}

WorstTile least_tile(const std::vector<float>& map, int width_px, int height_px) {
    return worst(map, width_px, height_px, -1);
}

}  // namespace sheer
