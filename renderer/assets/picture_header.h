#pragma once
#include <string_view>

#include "renderer/scene/assets.h"

namespace sheer {

enum class PictureFormat { png, jpeg, exr };

/// "PNG", "JPEG" or "OpenEXR file".
const char* name_of(PictureFormat format);

/// What a picture file says of itself before anything is decoded.
struct PictureHeader {
    PictureFormat format = PictureFormat::png;
    int width_px = 0;   ///< 1..max_picture_side_px
    int height_px = 0;  ///< 1..max_picture_side_px
};

inline constexpr int max_picture_side_px = 8192;

/// Reads the header and the frame of the file by ourselves, since decoders believe what a header says and take the
/// memory or the time for it. Sources: PNG (ISO 15948, clauses 5 and 11.2.2), JPEG (ITU-T T.81, annex B), "OpenEXR File
/// Layout".
/// Throws AssetError for another format, a side that is 0 or over the limit, a PNG or JPEG that is cut off, a CMYK
/// JPEG, and an OpenEXR file of several parts or of deep data.
PictureHeader read_picture_header(std::string_view bytes);

}  // namespace sheer
