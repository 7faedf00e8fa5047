#pragma once
#include <cstdint>

namespace sheer {

/// Seeded random numbers that are the same on every platform and standard library: SplitMix64 (Steele, Lea and Flood,
/// "Fast splittable pseudorandom number generators", OOPSLA 2014). Draw one number per declaration, or in braces:
/// compilers differ in the order in which they evaluate other expressions.
class Random {
  public:
    explicit Random(std::uint64_t seed) : m_state(seed) {}

    std::uint64_t next() {
        std::uint64_t z = (m_state += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    /// In [0, 1), 53 bits.
    double unit() { return static_cast<double>(next() >> 11) * 0x1p-53; }
    /// In [low, high).
    double between(double low, double high) { return low + (high - low) * unit(); }
    /// In [0, count); the bias of the remainder is below 2^-32 for counts below 2^32.
    std::uint64_t below(std::uint64_t count) { return next() % count; }

  private:
    std::uint64_t m_state;
};

}  // namespace sheer
