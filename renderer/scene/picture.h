#pragma once
#include <vector>

#include "renderer/core/notes.h"
#include "renderer/image/image.h"

namespace sheer {

/// A picture from a file, for textures: straight alpha, rows from the top down.
struct Picture {
    Image image;
    bool eight_bit = true;    ///< the file has 8 bits a channel, so that 8 bits keep all of it
    std::vector<Note> notes;  ///< what was read differently from the file
};

}  // namespace sheer
