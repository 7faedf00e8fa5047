// FLIP: what a person sees when flipping between the two pictures on a screen.
// Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild: "FLIP: A Difference Evaluator for Alternating
// Images", HPG 2020. The map is in renderer/metrics/shared/flip_map.cpp; here it is pooled and colored.

#include "renderer/metrics/shared/flip_map.h"

#include <algorithm>
#include <bit>

#include "renderer/image/magma.h"
#include "renderer/metrics/shared/metric.h"

namespace sheer {
namespace {

/// Exact order statistics of values in 0..1 in linear time: the order of such floats is that of their bits, so a
/// histogram of the upper 16 bits finds the bin, and one of the lower 16 bits in that bin finds the value.
class ErrorDistribution {
  public:
    explicit ErrorDistribution(const std::vector<float>& values) : m_values(values), m_count(bins), m_sum(bins) {
        for (const float value : values) {
            const auto bin = std::bit_cast<std::uint32_t>(value) >> 16;
            ++m_count[bin];
            m_sum[bin] += value;
        }
        for (const double sum : m_sum) m_total += sum;
        m_max = *std::max_element(values.begin(), values.end());
    }

    double mean() const { return m_total / double(m_values.size()); }
    double max() const { return m_max; }

    /// Nearest rank: the smallest value that at least `percent` % of the pixels do not exceed.
    double percentile(std::uint64_t percent) const {
        const std::size_t rank = (m_values.size() * percent + 99) / 100;
        return find(double(rank), [](double count, double) { return count; });
    }

    /// Pixels weighted by their own value: the smallest value such that the pixels that do not exceed it hold at least
    /// `share` of the sum of all.
    double weighted(double share) const {
        return find(share * m_total, [](double, double sum) { return sum; });
    }

  private:
    static constexpr std::size_t bins = 1 << 16;

    /// The value at which the running mass, made of counts or of sums, reaches `target`.
    template <typename Mass>
    double find(double target, const Mass& mass) const {
        double before = 0;
        std::size_t bin = 0;
        while (bin + 1 < bins && before + mass(double(m_count[bin]), m_sum[bin]) < target) {
            before += mass(double(m_count[bin]), m_sum[bin]);
            ++bin;
        }
        std::vector<std::uint32_t> count(bins);
        for (const float value : m_values) {
            const auto bits = std::bit_cast<std::uint32_t>(value);
            if (bits >> 16 == bin) ++count[bits & 0xffff];
        }
        double last = m_max;  // the sums may just miss the target because of rounding
        for (std::size_t low = 0; low < bins; ++low) {
            if (count[low] == 0) continue;
            last = std::bit_cast<float>(std::uint32_t(bin << 16 | low));
            before += mass(count[low], count[low] * last);
            if (before >= target) break;
        }
        return last;
    }

    const std::vector<float>& m_values;
    std::vector<std::uint32_t> m_count;
    std::vector<double> m_sum;
    double m_total = 0;
    double m_max = 0;
};

Image8 colored(const std::vector<float>& map, int width, int height) {
    Image8 picture(width, height);
    for (std::size_t i = 0; i < map.size(); ++i) {
        const auto& color = magma()[std::size_t(map[i] * 255 + 0.5f)];
        std::copy(color.begin(), color.end(), &picture.rgb[i * 3]);
    }
    return picture;
}

MetricValue compute_flip(const ImagePair& pair) {
    const std::vector<float> map = flip_map(pair.reference8, pair.test8);
    const ErrorDistribution distribution(map);
    return {{{"mean", distribution.mean()},
             {"weighted_median", distribution.weighted(0.5)},
             {"weighted_q1", distribution.weighted(0.25)},
             {"weighted_q3", distribution.weighted(0.75)},
             {"max", distribution.max()},
             {"p95", distribution.percentile(95)},
             {"p99", distribution.percentile(99)}},
            colored(map, pair.reference8.width_px, pair.reference8.height_px)};
}

}  // namespace

MetricInfo metric_flip() {
    const auto over_pixels = [](std::string name, std::string summary, MetricColumn column = {}) {
        return MetricField{
            .name = std::move(name), .range = "0..1", .summary = std::move(summary), .column = std::move(column)};
    };
    return {
        .id = "flip",
        .name = "FLIP",
        .summary =
            "Visible difference when flipping between the pictures on a screen with 67 pixels per degree: 0 is none, "
            "1 the greatest possible. The picture shows it per pixel in magma colors, black to pale yellow for 0 to "
            "1.",
        .source = "Andersson et al., FLIP: A Difference Evaluator for Alternating Images, HPG 2020 (LDR-FLIP)",
        .formula = "LDR-FLIP of the paper at 67 pixels per degree",
        .good_for = "what a person notices when switching between the pictures; the best single measure for a preview",
        .picture = "flip",
        .place = 50,
        .fields = {over_pixels("mean", "Mean over the pixels",
                               {.head = "FLIP mean", .better = Better::lower, .terminal = {"FLIP", 4}}),
                   over_pixels("weighted_median",
                               "Value up to which the pixels account for half of the sum of all FLIP values"),
                   over_pixels("weighted_q1",
                               "Value up to which the pixels account for a quarter of the sum of all FLIP values"),
                   over_pixels("weighted_q3",
                               "Value up to which the pixels account for three quarters of the sum of all FLIP values"),
                   over_pixels("max", "Greatest value of any pixel"),
                   over_pixels("p95", "95th percentile of the pixels, nearest rank"),
                   over_pixels("p99", "99th percentile of the pixels, nearest rank")},
        .compute = compute_flip};
}

}  // namespace sheer
