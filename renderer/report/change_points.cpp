#include "renderer/report/change_points.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "renderer/core/random.h"

namespace sheer {

namespace {

constexpr std::size_t shortest_part = 3, window_side = 100;
constexpr int random_orders = 399, most_as_great = 1;

/// The values so far: how many and which sum below each rank (a Fenwick tree).
class RankedSums {
  public:
    explicit RankedSums(std::size_t size) : m_counts(size + 1), m_sums(size + 1) {}

    void add(std::size_t rank, double value, double sign) {
        m_count += sign;
        m_sum += sign * value;
        for (std::size_t i = rank + 1; i < m_counts.size(); i += i & (~i + 1)) {
            m_counts[i] += sign;
            m_sums[i] += sign * value;
        }
    }

    /// The sum of the distances of all its values from this one.
    double distances(std::size_t rank, double value) const {
        double count = 0, sum = 0;
        for (std::size_t i = rank + 1; i > 0; i &= i - 1) {
            count += m_counts[i];
            sum += m_sums[i];
        }
        return value * count - sum + (m_sum - sum) - value * (m_count - count);
    }

  private:
    std::vector<double> m_counts, m_sums;
    double m_count = 0, m_sum = 0;
};

struct Split {
    std::size_t at = 0;
    double distance = -1;
};

std::vector<std::size_t> ranks_of(std::span<const double> values) {
    std::vector<std::size_t> order(values.size()), ranks(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return std::pair(values[i], i); });
    for (std::size_t i = 0; i < order.size(); ++i) ranks[order[i]] = i;
    return ranks;
}

/// Values on both sides of a split that moves to the right, and the sums of the distances within and between them.
class Sides {
  public:
    explicit Sides(std::size_t size) : m_left(size), m_right(size) {}

    void add_right(std::size_t rank, double value) {
        m_within_right += m_right.distances(rank, value);
        m_between += m_left.distances(rank, value);
        m_right.add(rank, value, 1);
        m_right_count += 1;
    }

    void move_left(std::size_t rank, double value) {
        m_right.add(rank, value, -1);
        const double from_left = m_left.distances(rank, value), from_right = m_right.distances(rank, value);
        m_within_right -= from_right;
        m_within_left += from_left;
        m_between += from_right - from_left;
        m_left.add(rank, value, 1);
        m_right_count -= 1;
        m_left_count += 1;
    }

    /// The energy distance, weighted as in the paper's equation 7.
    double distance() const {
        const double n = m_left_count, m = m_right_count;
        const double energy =
            2 * m_between / (n * m) - 2 * m_within_left / (n * (n - 1)) - 2 * m_within_right / (m * (m - 1));
        return n * m / (n + m) * energy;
    }

  private:
    RankedSums m_left, m_right;
    double m_within_left = 0, m_within_right = 0, m_between = 0;
    double m_left_count = 0, m_right_count = 0;
};

/// The best split with so many values on its right side.
void look_for_split(std::span<const double> values, std::span<const std::size_t> ranks, std::size_t right_size,
                    Split& best) {
    Sides sides(values.size());
    for (std::size_t i = 0; i < std::min(right_size, values.size()); ++i) sides.add_right(ranks[i], values[i]);
    const bool is_to_the_end = right_size >= values.size();
    const std::size_t last = is_to_the_end ? values.size() - shortest_part : values.size() - right_size;
    for (std::size_t at = 1; at <= last; ++at) {
        sides.move_left(ranks[at - 1], values[at - 1]);
        if (const std::size_t next = at + right_size - 1; !is_to_the_end) sides.add_right(ranks[next], values[next]);
        if (at < shortest_part) continue;
        if (const double distance = sides.distance(); distance > best.distance) best = {at, distance};
    }
}

/// The split with the greatest distance between everything on its left and what is on its right up to some place: all,
/// or a power of two of values, so that a level which returns after some time is found as well.
Split best_split(std::span<const double> values, std::span<const std::size_t> ranks) {
    Split best;
    for (std::size_t right_size = 4; right_size < values.size(); right_size *= 2)
        look_for_split(values, ranks, right_size, best);
    look_for_split(values, ranks, values.size(), best);
    return best;
}

/// How often random orders of the values around a split have as great a distance.
double probability_of(std::span<const double> part, std::size_t at) {
    const std::size_t begin = at > window_side ? at - window_side : 0;
    const std::size_t end = std::min(part.size(), at + window_side);
    std::vector<double> values(part.begin() + static_cast<std::ptrdiff_t>(begin),
                               part.begin() + static_cast<std::ptrdiff_t>(end));
    std::vector<std::size_t> ranks = ranks_of(values);
    const double there = best_split(values, ranks).distance;
    Random random(values.size());
    int as_great = 0;
    for (int order = 0; order < random_orders && as_great <= most_as_great; ++order) {
        for (std::size_t i = values.size(); i > 1; --i) {
            const auto other = static_cast<std::size_t>(random.below(i));
            std::swap(values[i - 1], values[other]);
            std::swap(ranks[i - 1], ranks[other]);
        }
        // Rounding differs with the order.
        if (best_split(values, ranks).distance >= there * (1 - 1e-9)) ++as_great;
    }
    return (1.0 + as_great) / (1.0 + random_orders);
}

double median_of(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    if (values.size() % 2 == 1) return *middle;
    return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

Level level_of(const std::vector<Measured>& series, std::size_t begin, std::size_t end) {
    const auto median = [&](double Measured::*member) {
        std::vector<double> values;
        for (std::size_t i = begin; i < end; ++i) values.push_back(series[i].*member);
        return median_of(std::move(values));
    };
    return {begin, end, median(&Measured::value), median(&Measured::low), median(&Measured::high)};
}

bool overlap(const Level& a, const Level& b) {
    return a.low <= b.high && b.low <= a.high;
}

struct FoundSplit {
    std::size_t at;
    double p;
};

void split_part(const std::vector<Measured>& series, std::span<const double> values, std::size_t begin, std::size_t end,
                std::vector<FoundSplit>& found) {
    if (end - begin < 2 * shortest_part) return;
    const std::span<const double> part = values.subspan(begin, end - begin);
    const Split split = best_split(part, ranks_of(part));
    if (split.distance <= 0) return;
    const std::size_t at = begin + split.at;
    const double p = probability_of(part, split.at);
    if (p > (1.0 + most_as_great) / (1.0 + random_orders)) return;
    split_part(series, values, begin, at, found);
    found.push_back({at, p});
    split_part(series, values, at, end, found);
}

}  // namespace

std::vector<ChangePoint> change_points(const std::vector<Measured>& series) {
    std::vector<double> values;
    for (const Measured& each : series) values.push_back(each.value);
    std::vector<FoundSplit> found;
    split_part(series, values, 0, series.size(), found);
    std::vector<ChangePoint> points;
    // Without the changes whose levels overlap, those beside them have longer levels.
    for (bool again = true; again;) {
        again = false;
        points.clear();
        for (std::size_t i = 0; i < found.size() && !again; ++i) {
            const std::size_t begin = i == 0 ? 0 : found[i - 1].at;
            const std::size_t end = i + 1 == found.size() ? series.size() : found[i + 1].at;
            const ChangePoint point{found[i].at, level_of(series, begin, found[i].at),
                                    level_of(series, found[i].at, end), found[i].p};
            again = overlap(point.before, point.after);
            if (again) found.erase(found.begin() + static_cast<std::ptrdiff_t>(i));
            points.push_back(point);
        }
    }
    return points;
}

}  // namespace sheer
