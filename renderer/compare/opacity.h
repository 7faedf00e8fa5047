#pragma once
#include "renderer/image/image.h"
#include "renderer/metrics/shared/metric.h"

namespace sheer {

/// How much of the background each channel of a picture hides: 0 for all of it showing, 255 for none. A pixel over a
/// background B is C + T B, so that the pictures over black and white give T.
Image8 opacity_of(const Backdrops& over);

}  // namespace sheer
