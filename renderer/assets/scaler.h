#pragma once
#include <vector>

#include "renderer/image/image.h"

namespace sheer {

/// Scales a picture that arrives row by row, so that a large one is never completely in memory.
///
/// Each axis is scaled separately: if it shrinks, by the mean of what a target pixel covers; if it grows, by
/// Catmull-Rom interpolation with the outermost pixels repeated. Colors are weighted by their alpha; where the result's
/// alpha is 0, the color is the plain mean, so that it is still sensible.
class Scaler {
  public:
    /// All in pixels and at least 1.
    Scaler(int source_width, int source_height, int target_width, int target_height);

    /// Row `y` from the top, `source_width` pixels of 4 channels, straight alpha. Call it at most once for each row, in
    /// any order; a missing row is transparent black.
    void add_row(int y, const float* rgba);
    /// Straight alpha. Alpha is in 0..1, colors are at least 0: interpolation would overshoot at edges.
    Image finish() const;

  private:
    static constexpr int channels = 7;  // color weighted by alpha, alpha, plain color

    struct Tap {
        int target;
        float weight;
    };
    /// For every source pixel of an axis, the target pixels to which it contributes.
    static std::vector<std::vector<Tap>> make_taps(int source, int target);

    int m_width, m_height;
    std::vector<std::vector<Tap>> m_columns, m_rows;
    std::vector<float> m_row;   ///< of the target's width
    std::vector<float> m_sums;  ///< of the target's size
};

}  // namespace sheer
