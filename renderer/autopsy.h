#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "renderer/frame/pixel_trace.h"
#include "renderer/gl/context.h"
#include "renderer/scene/assets.h"
#include "renderer/spec/spec.h"

namespace sheer {

using Rgb = std::array<double, 3>;

/// A transparent fragment of a pixel, and its part in the exact picture.
struct PixelFragment {
    double depth = 0;                 ///< as the depth buffer has it, 0..1, 0 nearest
    Rgb color{};                      ///< 0..1, not premultiplied
    double alpha = 0;                 ///< 0..1
    std::uint32_t primitive = 0;      ///< its number in the scene, opaque primitives counted too
    double transmittance_before = 1;  ///< what the nearer fragments let through, 0..1
    double weight = 0;                ///< transmittance_before * alpha: how much of its colour is seen
};

/// The opaque surface that shows behind the transparent fragments.
struct OpaqueFragment {
    double depth = 0;
    Rgb color{};
};

/// What a method made of a pixel, in its own terms.
struct Explanation {
    std::vector<PixelFact> facts;
    std::optional<Rgb> value;  ///< of the pixel as it was drawn for this, in the spec's format
    std::string reason;        ///< why there is nothing
};

/// Everything that a pixel of the exact picture is made of.
struct PixelStack {
    Rgb background{};                      ///< of the spec
    std::optional<OpaqueFragment> opaque;  ///< none where the background shows
    /// Near to far; of equal depths the later submitted primitive first. Fragments that `opaque` hides are left out.
    std::vector<PixelFragment> fragments;
    double transmittance = 1;  ///< what all fragments let through
    Rgb sum{};                 ///< the fragments' colours and what is behind them, weighted, in double precision
    std::vector<Explanation> methods;  ///< of the spec's methods, in its order
};

/// Most fragments of a pixel that are taken apart.
inline constexpr std::uint32_t max_pixel_fragments = 200'000;
/// Most fragments of a pixel of which methods are explained: each is drawn by itself.
inline constexpr std::size_t max_explained_fragments = 5'000;

/// Draws the scene of a spec that is at one point, and keeps every fragment of the pixel (x, y), from the top left,
/// which must be inside the image; then draws a frame of each method at that pixel, which the method explains, and all
/// frames before it where the method keeps them. Opaque surfaces and colours are in 32-bit floats, as in references.
/// Throws SpecError and RenderError as compare() does; Unsupported if there are over max_pixel_fragments.
PixelStack take_pixel_apart(const Spec& spec, gl::Context& context, AssetReader& assets, int x, int y);

/// Fills in weights, transmittances and sum from depth, colour and alpha of fragments that are sorted.
void weigh(PixelStack& stack);

}  // namespace sheer
