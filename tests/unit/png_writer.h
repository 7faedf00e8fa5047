#pragma once
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sheer {

/// PNG files chunk by chunk (ISO 15948), so that tests can write files that no encoder would.
inline std::string u32_big(std::uint32_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 255);
    return bytes;
}

inline std::string png_chunk(std::string_view name, std::string_view data) {
    const std::string content = std::string(name) + std::string(data);
    const auto sum = crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size()));
    return u32_big(static_cast<std::uint32_t>(data.size())) + content + u32_big(static_cast<std::uint32_t>(sum));
}

inline std::string deflated(const std::string& bytes) {
    std::string packed(compressBound(bytes.size()), '\0');
    uLongf size = packed.size();
    EXPECT_EQ(compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                       bytes.size()),
              Z_OK);
    packed.resize(size);
    return packed;
}

struct PngParts {
    std::uint32_t width_px = 1, height_px = 1;
    int depth = 8, color_type = 2;  ///< 0 gray, 2 RGB, 3 palette, 4 gray and alpha, 6 RGBA
    bool interlaced = false;
    std::string before_data;  ///< whole chunks
    std::string rows;         ///< each preceded by its filter byte
    std::string after;        ///< after IEND
};

inline std::string png_of(const PngParts& parts) {
    const std::string header = u32_big(parts.width_px) + u32_big(parts.height_px) + static_cast<char>(parts.depth) +
                               static_cast<char>(parts.color_type) + std::string(2, '\0') +
                               static_cast<char>(parts.interlaced ? 1 : 0);
    return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", header) + parts.before_data +
           png_chunk("IDAT", deflated(parts.rows)) + png_chunk("IEND", "") + parts.after;
}

/// EXIF data with only an orientation, in either byte order.
inline std::string exif_of(int orientation, bool big_endian) {
    std::string tiff = big_endian ? "MM" : "II";
    const auto put = [&](std::uint32_t value, int bytes) {
        for (int i = 0; i < bytes; ++i) tiff += static_cast<char>(value >> 8 * (big_endian ? bytes - 1 - i : i) & 255);
    };
    put(42, 2);
    put(8, 4);
    put(2, 2);
    // The width comes first, so that the orientation is not the first entry.
    for (const auto& [tag, type, value, bytes] :
         {std::array<std::uint32_t, 4>{0x0100, 4, 7, 4}, {0x0112, 3, static_cast<std::uint32_t>(orientation), 2}}) {
        put(tag, 2);
        put(type, 2);
        put(1, 4);
        put(value, static_cast<int>(bytes));
        tiff.append(4 - bytes, '\0');
    }
    put(0, 4);
    return tiff;
}

}  // namespace sheer
