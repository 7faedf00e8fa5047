#include "renderer/compare/opacity.h"

namespace sheer {

Image8 opacity_of(const Backdrops& over) {
    Image opacity(over.black.width_px, over.black.height_px);
    for (std::size_t i = 0; i < opacity.rgba.size(); ++i)
        opacity.rgba[i] = 1.0f - (over.white.rgba[i] - over.black.rgba[i]);
    return quantize(opacity);
}

}  // namespace sheer
