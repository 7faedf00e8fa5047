#pragma once
#include "renderer/frame/image.h"

namespace sheer {

/// A picture from a file, for textures: straight alpha, rows from the top down.
struct Picture {
    Image image;
    bool eight_bit = true;  ///< the file has 8 bits a channel, so that 8 bits keep all of it
};

}  // namespace sheer
