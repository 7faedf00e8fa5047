#pragma once
#include <map>
#include <string>
#include <vector>

#include "renderer/litmus/drawing.h"
#include "renderer/litmus/scenes.h"

namespace sheer::litmus {

/// The pixels of a scene's picture, litmus_size_px times litmus_size_px, rows from the top.
using Pixels = std::vector<Color>;

/// How far pictures are from those of a drawing.
struct Fit {
    double rms_levels = 0;       ///< of all channels of all pixels, in 8-bit levels
    double greatest_levels = 0;  ///< of one channel
    std::string worst_scene;     ///< the one that fits least
    /// The mean square of the differences, each relative to what rounding and, for random pictures, chance explain; and
    /// that of the worst scene. 1 is expected at most.
    double excess = 0, worst_excess = 0;
    /// Of random pictures: the mean square of how many standard deviations the mean of equal pixels is off; 1 is
    /// expected.
    double bias = 0;
    double likelihood = 0;  ///< its logarithm, up to a constant
};

struct Identification {
    /// The pictures are those of `drawings`, to within rounding; otherwise of none that is known, and these are the
    /// nearest.
    bool found = false;
    std::vector<Drawing> drawings;  ///< the likeliest, and those whose pictures are the same
    Fit fit;                        ///< of the likeliest
    Drawing next;                   ///< the likeliest of the others
    Fit next_fit;
};

/// Knows the pictures of every formula with each of its variants, orders, colors and blendings. Takes seconds to make.
class Identifier {
  public:
    Identifier();

    /// `pictures` by the id of the scene; at least one. Those of unknown ids are ignored.
    Identification identify(const std::map<std::string, Pixels>& pictures) const;

    const std::vector<Drawing>& drawings() const { return m_drawings; }
    /// What `drawing` would give, for a scene's every pixel.
    static Pixels draw(const LitmusScene& scene, const Drawing& drawing);

  private:
    /// A scene's pixels, of which many have the same contents.
    struct KnownScene {
        std::string id;
        std::vector<Stack> stacks, by_middles;
        std::vector<std::size_t> stack_of_pixel;
    };
    /// A scene's distinct pixels in a drawing.
    struct Prediction {
        std::vector<Color> means, variances;
    };
    using Predictions = std::vector<Prediction>;  ///< by scene

    static KnownScene known(const LitmusScene& scene);
    static Prediction predict(const KnownScene& scene, const Drawing& drawing, const Formula& mean,
                              const Formula& variance);
    Fit fit(const Predictions& predictions, const std::map<std::string, Pixels>& pictures) const;
    bool same(std::size_t a, std::size_t b, const std::map<std::string, Pixels>& pictures) const;

    std::vector<KnownScene> m_scenes;
    std::vector<Drawing> m_drawings;
    std::vector<Predictions> m_predictions;  ///< by drawing
};

}  // namespace sheer::litmus
