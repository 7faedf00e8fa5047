#pragma once
#include <vector>

#include "renderer/scene/textures.h"

namespace sheer {

/// Scales the alphas of each level after the first so that as large a share of it as of the first has at least
/// `alpha` (0..1): what an alpha test against `alpha` leaves of a surface is then the same at every distance, whereas
/// plain means make thin things fade below it. Alphas stay within 0..1. Nothing changes if the first level has no such
/// texel. (Castaño, Computing Alpha Mipmaps, 2010.)
void keep_alpha_coverage(std::vector<TextureLevel>& levels, double alpha);
void keep_alpha_coverage(std::vector<Image>& levels, double alpha);

}  // namespace sheer
