#pragma once
#include <string_view>
#include <vector>

#include "renderer/core/notes.h"
#include "renderer/scene/assets.h"

namespace sheer {

enum class PictureFormat { png, jpeg, exr, webp };

/// "PNG", "JPEG", "OpenEXR file" or "WebP".
const char* name_of(PictureFormat format);

/// What a picture file says about itself before anything is decoded.
struct PictureHeader {
    PictureFormat format = PictureFormat::png;
    int width_px = 0;         ///< as it is seen: turned by its orientation, within its display window;
    int height_px = 0;        ///< 1..max_picture_side_px
    int orientation = 1;      ///< 1..8, EXIF's tag 0x0112; from 5 on rows of the file are seen as columns
    std::vector<Note> notes;  ///< what is not read from the file, or read differently
};

inline constexpr int max_picture_side_px = 8192;

/// Whether rows of the file are seen as columns.
inline bool is_transposed(const PictureHeader& header) {
    return header.orientation >= 5;
}

/// Reads all of the file except its pixels with our own code, since decoders trust the header, allocate memory and
/// spend time accordingly, and fill in what is missing. Sources: PNG (ISO 15948, clauses 5, 10 and 11), JPEG (ITU-T
/// T.81, annexes B and G), EXIF 2.3 (4.6.4), "OpenEXR File Layout", WebP (RFC 9649).
///
/// Throws AssetError for another format, a side that is 0 or over the limit, and a file that is cut off; for a PNG with
/// a wrong checksum, or with damaged or too little image data; for a JPEG that is neither grey nor has three
/// components, is lossless or hierarchical, or lacks scans or parts of them; for an OpenEXR file with several parts or
/// deep data, and for one without R, G and B, or Y, outside of layers as halves or floats.
PictureHeader read_picture_header(std::string_view bytes);

}  // namespace sheer
