#pragma once
#include <vector>

#include "renderer/frame/image.h"

namespace sheer {

/// Scales a picture that comes row by row, so that a large one is never in memory as a whole.
///
/// Each axis on its own: where it shrinks, the mean of what a target pixel covers; where it grows, Catmull-Rom
/// interpolation with the outermost pixels continued. Colours are weighted by their alpha; where the result's alpha is
/// 0 it has the plain mean of the colours, so that something sensible is under it.
class Scaler {
  public:
    /// All in pixels and at least 1.
    Scaler(int source_width, int source_height, int target_width, int target_height);

    /// Row `y` from the top, `source_width` pixels of 4 channels, straight alpha. Every row once, in any order; a row
    /// that does not come is transparent black.
    void add_row(int y, const float* rgba);
    /// Straight alpha. Alpha is in 0..1, colours are at least 0: interpolation would overshoot at edges.
    Image finish() const;

  private:
    static constexpr int channels = 7;  // colour weighted by alpha, alpha, plain colour

    struct Tap {
        int target;
        float weight;
    };
    /// For every source pixel of an axis, where it goes.
    static std::vector<std::vector<Tap>> make_taps(int source, int target);

    int m_width, m_height;
    std::vector<std::vector<Tap>> m_columns, m_rows;
    std::vector<float> m_row;   ///< of the target's width
    std::vector<float> m_sums;  ///< of the target's size
};

}  // namespace sheer
