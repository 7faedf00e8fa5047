#include "renderer/metrics/shared/ssim_map.h"

#include <algorithm>
#include <memory>

#include "renderer/core/work_queue.h"
#include "renderer/metrics/shared/taps.h"

namespace sheer {
namespace {

constexpr int window_radius = 5;
constexpr double sigma_px = 1.5;
constexpr float c1 = (0.01f * 255) * (0.01f * 255);
constexpr float c2 = (0.03f * 255) * (0.03f * 255);

constexpr int ssim_tile_width = 128;
constexpr int ssim_tile_height = 64;
constexpr int ssim_source_width = ssim_tile_width + 2 * window_radius;
constexpr int ssim_source_height = ssim_tile_height + 2 * window_radius;

using SsimRow = std::array<float, ssim_tile_width>;
using SsimSourceRow = std::array<float, ssim_source_width>;

/// Working memory of one thread. Instead of the moments of x and y, those of s = x + y and d = x - y are used:
/// 2 cov(x, y) = (var s - var d) / 2 and var x + var y = (var s + var d) / 2, and likewise for the means. Where the
/// pictures are nearly equal, d is small and exact, and the rounding of var s cancels between numerator and
/// denominator.
struct SsimScratch {
    SsimSourceRow sum, difference, sum_squared, difference_squared;
    std::array<SsimRow, ssim_source_height> sum_x, difference_x, sum_squared_x,
        difference_squared_x;  ///< filtered along rows
};

/// The windows' centres, and the windows' shape.
struct Windows {
    int left, top, width, height;  ///< of the centres, px
    Taps<window_radius> across, down;

    explicit Windows(const Image8& image) {
        const int reach_x = std::min(window_radius, (image.width_px - 1) / 2);
        const int reach_y = std::min(window_radius, (image.height_px - 1) / 2);
        left = reach_x;
        top = reach_y;
        width = image.width_px - 2 * reach_x;
        height = image.height_px - 2 * reach_y;
        across = gaussian_taps<window_radius>(sigma_px, reach_x);
        down = gaussian_taps<window_radius>(sigma_px, reach_y);
    }
};

/// The sum is kept around 0, so that its square loses fewer bits; a shift does not change the variance.
constexpr float middle_level = 255;

struct SsimTile {
    int left, top, width, height;  ///< of the centres, px in the picture
};

void filter_rows(const ImagePair& pair, const Windows& windows, const SsimTile& tile, int channel,
                 SsimScratch& scratch) {
    const int last_x = pair.reference8.width_px - 1;
    const int last_y = pair.reference8.height_px - 1;
    for (int y = 0; y < tile.height + 2 * window_radius; ++y) {
        // Pixels outside the picture meet taps of 0 or centres that do not count: any finite value will do.
        const int from_y = std::clamp(tile.top + y - window_radius, 0, last_y);
        const std::uint8_t* one = pair.reference8.pixel(0, from_y) + channel;
        const std::uint8_t* two = pair.test8.pixel(0, from_y) + channel;
        for (int x = 0; x < ssim_source_width; ++x) {
            const int from_x = std::clamp(tile.left + x - window_radius, 0, last_x);
            scratch.sum[x] = float(one[from_x * 3] + two[from_x * 3]) - middle_level;
            scratch.difference[x] = float(one[from_x * 3] - two[from_x * 3]);
        }
        for (int x = 0; x < ssim_source_width; ++x) {
            scratch.sum_squared[x] = scratch.sum[x] * scratch.sum[x];
            scratch.difference_squared[x] = scratch.difference[x] * scratch.difference[x];
        }
        const auto across = [&](const SsimSourceRow& from, SsimRow& to) {
            for (int x = 0; x < ssim_tile_width; ++x)
                to[x] = even_sum<window_radius, 1>(&from[x + window_radius], windows.across);
        };
        across(scratch.sum, scratch.sum_x[y]);
        across(scratch.difference, scratch.difference_x[y]);
        across(scratch.sum_squared, scratch.sum_squared_x[y]);
        across(scratch.difference_squared, scratch.difference_squared_x[y]);
    }
}

/// Adds a third of the SSIM of a channel in row `y` of a tile to `out`.
void add_row(const Windows& windows, const SsimTile& tile, int y, const SsimScratch& scratch, float* out) {
    SsimRow sum, difference, sum_squared, difference_squared, ssim;
    const auto down = [&](const std::array<SsimRow, ssim_source_height>& from, SsimRow& to) {
        const float* centre = from[y + window_radius].data();
        for (int x = 0; x < ssim_tile_width; ++x)
            to[x] = even_sum<window_radius, ssim_tile_width>(centre + x, windows.down);
    };
    down(scratch.sum_x, sum);
    down(scratch.difference_x, difference);
    down(scratch.sum_squared_x, sum_squared);
    down(scratch.difference_squared_x, difference_squared);
    for (int x = 0; x < ssim_tile_width; ++x) {
        const float sum_variance = sum_squared[x] - sum[x] * sum[x];
        const float difference_variance = difference_squared[x] - difference[x] * difference[x];
        const float sum_mean = sum[x] + middle_level;
        const float sum_power = sum_mean * sum_mean;
        const float difference_power = difference[x] * difference[x];
        ssim[x] = (sum_power - difference_power + 2 * c1) * (sum_variance - difference_variance + 2 * c2) /
                  ((sum_power + difference_power + 2 * c1) * (sum_variance + difference_variance + 2 * c2));
    }
    for (int x = 0; x < tile.width; ++x) out[x] += ssim[x] / 3;
}

}  // namespace

SsimMap ssim_map(const ImagePair& pair) {
    const Windows windows(pair.reference8);
    SsimMap map{windows.left, windows.top, windows.width, windows.height,
                std::vector<float>(std::size_t(windows.width) * windows.height)};
    const int columns = (windows.width + ssim_tile_width - 1) / ssim_tile_width;
    const int rows = (windows.height + ssim_tile_height - 1) / ssim_tile_height;
    share_work(columns * rows, [&](WorkQueue& queue) {
        const auto scratch = std::make_unique<SsimScratch>();
        for (int index; queue.take(index);) {
            const int x = index % columns * ssim_tile_width;
            const int y = index / columns * ssim_tile_height;
            const SsimTile tile{windows.left + x, windows.top + y, std::min(ssim_tile_width, windows.width - x),
                                std::min(ssim_tile_height, windows.height - y)};
            for (int channel = 0; channel < 3; ++channel) {
                filter_rows(pair, windows, tile, channel, *scratch);
                for (int row = 0; row < tile.height; ++row)
                    add_row(windows, tile, row, *scratch, &map.values[std::size_t(y + row) * windows.width + x]);
            }
        }
    });
    return map;
}

}  // namespace sheer
