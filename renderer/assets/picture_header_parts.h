#pragma once
#include <cstdint>
#include <string_view>

#include "renderer/assets/picture_header.h"

namespace sheer {

/// Each reads a file that begins as its format does; see read_picture_header.
PictureHeader read_png_header(std::string_view bytes);
PictureHeader read_jpeg_header(std::string_view bytes);
PictureHeader read_exr_header(std::string_view bytes);
PictureHeader read_webp_header(std::string_view bytes);

/// Throws AssetError for sides that are 0 or over the limit.
void check_picture_size(PictureFormat format, std::int64_t width_px, std::int64_t height_px);

/// Turns the header, whose size is that of the file's rows, and adds a note; does nothing for 1 or an invalid value.
void set_orientation(PictureHeader& header, int orientation);
/// Of EXIF data, which is a TIFF file; like viewers, 1 if it has none or is broken.
int exif_orientation(std::string_view tiff);

/// White and primaries, x and y each: red, green, blue, white.
struct Chromaticities {
    double xy[8];
};
/// Adds a note if they are not those of Rec. 709 and sRGB.
void note_chromaticities(PictureHeader& header, const Chromaticities& chromaticities);

/// Adds a note if there are any.
void note_trailing_bytes(PictureHeader& header, std::size_t count);

}  // namespace sheer
