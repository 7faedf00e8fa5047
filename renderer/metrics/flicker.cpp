// Noise, and races between fragments, that a single picture does not show: how much it changes from one frame to the
// next while nothing moves.
#include <algorithm>
#include <array>
#include <cstdlib>

#include "renderer/metrics/shared/metric.h"

namespace sheer {
namespace {

/// How many pixels changed by how many levels, in their channel that changed most.
class Changes {
  public:
    void add(const Image8& before, const Image8& after) {
        const std::uint8_t *one = before.rgb.data(), *two = after.rgb.data();
        for (std::size_t pixel = 0; pixel < before.pixel_count(); ++pixel, one += 3, two += 3) {
            int greatest = 0;
            for (int c = 0; c < 3; ++c) greatest = std::max(greatest, std::abs(int(two[c]) - int(one[c])));
            ++m_pixels[std::size_t(greatest)];
        }
        m_count += before.pixel_count();
    }

    double mean() const {
        double sum = 0;
        for (std::size_t level = 0; level < m_pixels.size(); ++level) sum += double(level) * double(m_pixels[level]);
        return sum / double(m_count);
    }

    /// Nearest rank: the fewest levels that at least 99 % of the changes do not exceed.
    std::size_t p99() const {
        const std::uint64_t rank = (m_count * 99 + 99) / 100;
        std::size_t level = 0;
        for (std::uint64_t below = m_pixels[0]; below < rank; below += m_pixels[level]) ++level;
        return level;
    }

  private:
    std::array<std::uint64_t, 256> m_pixels{};
    std::uint64_t m_count = 0;
};

MetricValue compute_flicker(const ImagePair& pair) {
    const std::vector<Image8>* frames = pair.more.test_frames;
    if (!frames || frames->size() < 2)
        return {{{"mean", nullptr}, {"p99", nullptr}, {"reason", "only one frame was rendered"}}, std::nullopt};
    Changes changes;
    for (std::size_t i = 1; i < frames->size(); ++i) changes.add((*frames)[i - 1], (*frames)[i]);
    return {{{"mean", changes.mean()}, {"p99", changes.p99()}}, std::nullopt};
}

}  // namespace

MetricInfo metric_flicker() {
    return {.id = "flicker",
            .name = "Flicker",
            .summary =
                "Change of the picture from frame to frame while nothing in the scene moves, over four frames: of each "
                "pixel, that of the channel that changes most. Null with a reason if there is only one frame.",
            .source = "Mean and percentile of absolute differences",
            .formula = "mean and 99th percentile of max over r, g, b of |tᵢ₊₁ − tᵢ|",
            .good_for = "noise and dither that a single picture hides; 0 for a method without any",
            .place = 58,
            .fields = {{.name = "mean",
                        .unit = "levels",
                        .range = "0..255",
                        .summary = "Mean change of a pixel from frame to frame",
                        .column = {.head = "Flicker", .better = Better::lower}},
                       {.name = "p99",
                        .unit = "levels",
                        .range = "0..255",
                        .summary = "99 % of the changes of a pixel from frame to frame are at most this"}},
            .compute = compute_flicker};
}

}  // namespace sheer
