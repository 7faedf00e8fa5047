#pragma once
#include <array>
#include <string>

#include "renderer/image/image.h"
#include "renderer/image/pixel_counts.h"

namespace sheer {

/// PNG of 8 bits per channel, RGB. Throws std::runtime_error with the encoder's message.
std::string encode_png(const Image8& image);
/// JPEG of 8 bits per channel, RGB, for pictures that are only viewed.
std::string encode_jpeg(const Image8& image);
/// OpenEXR of 32-bit floats, RGBA, ZIP-compressed: the values as the method left them. Equal pictures give equal bytes.
std::string encode_exr(const Image& image);
/// OpenEXR of 32-bit floats, one channel: each count as it is, up to 2^24.
std::string encode_exr(const PixelCounts& counts);

/// Reads a PNG file that Sheer or a test wrote; not for files from outside. Throws std::runtime_error naming the file.
Image8 read_png(const std::string& path);

/// The same from bytes. Before decoding, refuses data that is not a PNG file or has an unexpected size, since decoders
/// trust the size in the header.
Image8 decode_png(const std::string& bytes, int width_px, int height_px);

/// Red, green and blue of one pixel, from the top left, of a PNG or OpenEXR file that Sheer wrote: 8-bit levels as
/// fractions of 1, floats as they are; channels that the file does not have are 0. Throws std::runtime_error.
std::array<double, 3> read_pixel(const std::string& bytes, int x, int y);

}  // namespace sheer
