#include "renderer/assets/picture_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "renderer/assets/file_bytes.h"
#include "renderer/assets/picture_header_parts.h"

namespace sheer {

namespace {

using namespace std::string_view_literals;

struct Signature {
    std::string_view bytes;
    PictureHeader (*read)(std::string_view bytes);
};
constexpr Signature picture_signatures[] = {{"\x89PNG\r\n\x1a\n"sv, read_png_header},
                                            {"\xff\xd8\xff"sv, read_jpeg_header},
                                            {"\x76\x2f\x31\x01"sv, read_exr_header},
                                            {"RIFF"sv, read_webp_header}};

/// Numbers of a TIFF file, in the file's byte order. Zeros beyond its end.
class TiffNumbers {
  public:
    explicit TiffNumbers(std::string_view bytes) : m_bytes(bytes), m_big(bytes.starts_with("MM")) {}

    std::uint32_t at(std::size_t offset, std::size_t count) const {
        if (offset > m_bytes.size() || count > m_bytes.size() - offset) return 0;
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < count; ++i)
            value = value << 8 | static_cast<std::uint8_t>(m_bytes[offset + (m_big ? i : count - 1 - i)]);
        return value;
    }

  private:
    std::string_view m_bytes;
    bool m_big;
};

}  // namespace

const char* name_of(PictureFormat format) {
    if (format == PictureFormat::png) return "PNG";
    if (format == PictureFormat::webp) return "WebP";
    return format == PictureFormat::jpeg ? "JPEG" : "OpenEXR file";
}

void check_picture_size(PictureFormat format, std::int64_t width_px, std::int64_t height_px) {
    if (width_px < 1 || height_px < 1 || width_px > max_picture_side_px || height_px > max_picture_side_px)
        throw AssetError(fmt::format("the {} says that it has {} x {} pixels; a picture may have 1 to {} a side",
                                     name_of(format), width_px, height_px, max_picture_side_px));
}

int exif_orientation(std::string_view tiff) {
    constexpr std::uint32_t orientation_tag = 0x0112, entry_bytes = 12;
    const TiffNumbers numbers(tiff);
    const std::size_t directory = numbers.at(4, 4), count = numbers.at(directory, 2);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t entry = directory + 2 + i * entry_bytes;
        if (numbers.at(entry, 2) != orientation_tag) continue;
        const auto orientation = static_cast<int>(numbers.at(entry + 8, 2));
        return orientation >= 1 && orientation <= 8 ? orientation : 1;
    }
    return 1;
}

void set_orientation(PictureHeader& header, int orientation) {
    if (orientation == 1) return;
    header.orientation = orientation;
    if (is_transposed(header)) std::swap(header.width_px, header.height_px);
    add_note(header.notes,
             {"orientation-applied",
              fmt::format("The picture is turned according to its EXIF orientation, {}.", orientation), ""});
}

void note_chromaticities(PictureHeader& header, const Chromaticities& chromaticities) {
    constexpr double rec_709[8] = {0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290}, tolerance = 0.002;
    const auto same = [](double a, double b) { return std::abs(a - b) <= tolerance; };
    if (std::ranges::equal(chromaticities.xy, rec_709, same)) return;
    add_note(header.notes, {"chromaticities-ignored",
                            "The picture's primaries or white are not those of Rec. 709; its values are used as if "
                            "they were.",
                            ""});
}

void note_trailing_bytes(PictureHeader& header, std::size_t count) {
    if (count == 0) return;
    add_note(header.notes,
             {"trailing-bytes",
              fmt::format("{} bytes after the end of the {} are ignored.", count, name_of(header.format)), ""});
}

PictureHeader read_picture_header(std::string_view bytes) {
    for (const Signature& signature : picture_signatures)
        if (bytes.starts_with(signature.bytes)) return signature.read(bytes);
    throw AssetError("the file is not a PNG, JPEG, OpenEXR or WebP picture: its first bytes match none of them");
}

}  // namespace sheer
