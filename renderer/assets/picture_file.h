#pragma once
#include <functional>
#include <string_view>
#include <vector>

#include "renderer/assets/picture_header.h"
#include "renderer/core/notes.h"

namespace sheer {

/// What is known about a picture once all of it is decoded.
struct PictureFacts {
    PictureHeader header;
    int channels = 0;         ///< 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA
    bool eight_bit = true;    ///< otherwise 16-bit whole numbers or floats
    std::vector<Note> notes;  ///< what was read differently from the file
};

/// A row of the file, before it is turned by its orientation: y from the top, 4 channels a pixel, straight alpha,
/// values as in the file (8 and 16 bits as fractions of 1). For an OpenEXR file: a row of its display window.
using RowFunction = std::function<void(int y, const float* rgba)>;

/// Decodes a PNG, JPEG or OpenEXR picture, whose format is known from its first bytes, and passes on every row once,
/// except rows outside an OpenEXR file's data window, which are transparent black.
/// OpenEXR colors are premultiplied in the file; they are divided by their alpha if that is not 0.
/// Throws AssetError for what read_picture_header refuses, for pictures that cannot be decoded completely, and for
/// pixels that are not finite.
PictureFacts decode_picture(std::string_view bytes, const RowFunction& row);

/// The picture as it is seen, turned by its orientation, scaled to this size. No transfer function is applied: the
/// methods blend the values as they are. Colors are at least 0, and at most 1 (8 bits) or 65504 (the greatest 16-bit
/// float). A spec's texture, or one inside a model. Throws AssetError.
Picture read_picture(std::string_view bytes, int width_px, int height_px);

}  // namespace sheer
