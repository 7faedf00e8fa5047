#pragma once
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace sheer {

/// A picture file written by OpenImageIO: `format` is "png", "jpeg" or "openexr", `values` have `channels` per pixel.
/// Colors are stored as given, regardless of alpha.
template <typename Value>
std::string encode_picture(const std::string& format, int width_px, int height_px, int channels,
                           const std::vector<Value>& values, int tile_px = 0) {
    const OIIO::TypeDesc type = OIIO::TypeDescFromC<Value>::value();
    OIIO::ImageSpec spec(width_px, height_px, channels, type);
    spec["oiio:UnassociatedAlpha"] = 1;
    spec.attribute("jpeg:subsampling", "4:4:4");
    spec.attribute("CompressionQuality", 100);
    spec.tile_width = spec.tile_height = tile_px;
    const auto output = OIIO::ImageOutput::create(format);
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    EXPECT_TRUE(output && output->set_ioproxy(&memory) && output->open("picture." + format, spec) &&
                output->write_image(type, values.data()) && output->close())
        << output->geterror();
    return {bytes.begin(), bytes.end()};
}

/// Incompressible pixels, so that a truncated file always lacks some.
inline std::vector<std::uint8_t> noise(std::size_t count) {
    std::vector<std::uint8_t> values(count);
    std::uint32_t state = 1;
    for (std::uint8_t& value : values) {
        state = state * 1664525u + 1013904223u;
        value = static_cast<std::uint8_t>(state >> 24);
    }
    return values;
}

inline void put_u32_big(std::string& bytes, std::size_t at, std::uint32_t value) {
    for (int i = 0; i < 4; ++i) bytes[at + static_cast<std::size_t>(i)] = static_cast<char>(value >> (24 - 8 * i));
}

/// A complete PNG with a correct checksum, whose header has a different size than its data.
inline std::string with_png_size(std::string png, std::uint32_t width, std::uint32_t height) {
    put_u32_big(png, 16, width);
    put_u32_big(png, 20, height);
    std::uint32_t crc = ~0u;
    for (std::size_t i = 12; i < 29; ++i) {
        crc ^= static_cast<std::uint8_t>(png[i]);
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (0xedb88320u & (0u - (crc & 1)));
    }
    put_u32_big(png, 29, ~crc);
    return png;
}

}  // namespace sheer
