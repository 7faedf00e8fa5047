#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "renderer/gl/context.h"
#include "renderer/passes/pixel_trace.h"
#include "renderer/scene/assets.h"
#include "renderer/spec/spec.h"

namespace sheer {

using Rgb = std::array<double, 3>;

/// A transparent fragment of a pixel, and its contribution to the exact picture.
struct PixelFragment {
    double depth = 0;                 ///< as in the depth buffer, 0..1, 0 nearest
    Rgb color{};                      ///< 0..1, not premultiplied
    double alpha = 0;                 ///< 0..1
    std::uint32_t primitive = 0;      ///< its number in the scene, counting opaque primitives too
    double transmittance_before = 1;  ///< transmittance of the nearer fragments, 0..1
    double weight = 0;                ///< transmittance_before * alpha: how much of its color is visible
};

/// The opaque surface that shows behind the transparent fragments.
struct OpaqueFragment {
    double depth = 0;
    Rgb color{};
};

/// A method's explanation of a pixel, in its own terms.
struct Explanation {
    std::vector<PixelFact> facts;
    std::optional<Rgb> value;  ///< of the pixel as drawn for this explanation, in the spec's format
    std::string reason;        ///< why there is no explanation
};

/// Everything that contributes to a pixel of the exact picture.
struct PixelStack {
    Rgb background{};                      ///< of the spec
    std::optional<OpaqueFragment> opaque;  ///< none if the background is visible
    /// Near to far; at equal depths the later submitted primitive first. Fragments that `opaque` hides are left out.
    std::vector<PixelFragment> fragments;
    double transmittance = 1;  ///< of all fragments together
    Rgb sum{};                 ///< weighted sum of the fragments' colors and what is behind them, in double precision
    std::vector<Explanation> methods;  ///< of the spec's methods, in the spec's order
};

/// The most fragments for which a pixel is explained.
inline constexpr std::uint32_t max_pixel_fragments = 200'000;
/// The most fragments for which the methods are explained: each fragment is drawn separately.
inline constexpr std::size_t max_explained_fragments = 5'000;

/// Draws the scene of a spec with one point, and keeps every fragment of the pixel (x, y), from the top left, which
/// must be inside the image. Then draws a frame of each method at that pixel, and all previous frames if the method
/// depends on them, for the method to explain. Opaque surfaces and colors are in 32-bit floats, as in references.
/// Throws SpecError and RenderError as compare() does; Unsupported if there are over max_pixel_fragments.
PixelStack explain_pixel(const Spec& spec, gl::Context& context, AssetReader& assets, int x, int y);

/// Fills in weights, transmittances and sum from depth, color and alpha of sorted fragments.
void weigh(PixelStack& stack);

}  // namespace sheer
