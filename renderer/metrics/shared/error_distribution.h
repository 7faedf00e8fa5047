#pragma once
#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace sheer {

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

}  // namespace sheer
