#pragma once
#include <array>
#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

namespace sheer::litmus {

using Color = std::array<double, 3>;

struct Fragment {
    float depth;
    double alpha;
    Color color;
    std::size_t submitted = 0;  ///< place among the transparent layers
};

/// The contents of a pixel: the opaque picture, and the transparent fragments that it does not hide, as submitted.
struct Stack {
    Color below;
    std::vector<Fragment> fragments;
    std::size_t transparent_layers = 0;  ///< of the whole scene
    bool sums_in_16_bits = false;        ///< a method's sums are 16-bit floats, which overflow over 65,504
};

/// A method's value of a pixel; not clamped.
using Formula = std::function<Color(const Stack& stack)>;

/// The contents of each pixel of a `layers` scene, computed on the CPU in double precision from the spec alone: which
/// layers cover its middle, and what opaque ones hide.
class Compositor {
  public:
    /// `scene` as in a spec, complete. `sums_in_16_bits` as in Stack.
    Compositor(const nlohmann::json& scene, int size_px, Color background, bool sums_in_16_bits = false);

    Stack stack(int x, int y) const;
    Color pixel(int x, int y, const Formula& formula) const { return formula(stack(x, y)); }

  private:
    struct Layer {
        std::array<double, 4> rect;
        float depth;
        Color color;
        double alpha;
        bool opaque;
    };

    bool covers(const Layer& layer, int x, int y) const;

    std::vector<Layer> m_layers;
    int m_size_px;
    Color m_background;
    std::size_t m_transparent = 0;
    bool m_sums_in_16_bits;
};

}  // namespace sheer::litmus
