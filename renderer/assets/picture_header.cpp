#include "renderer/assets/picture_header.h"

#include <fmt/format.h>

#include "renderer/assets/file_bytes.h"

namespace sheer {

namespace {

using namespace std::string_view_literals;

constexpr std::string_view png_signature = "\x89PNG\r\n\x1a\n"sv;
constexpr std::string_view jpeg_signature = "\xff\xd8\xff"sv;
constexpr std::string_view exr_signature = "\x76\x2f\x31\x01"sv;

PictureHeader checked(PictureFormat format, std::int64_t width, std::int64_t height) {
    if (width < 1 || height < 1 || width > max_picture_side_px || height > max_picture_side_px)
        throw AssetError(fmt::format("the {} says that it has {} x {} pixels; a picture has 1 to {} a side",
                                     name_of(format), width, height, max_picture_side_px));
    return {format, static_cast<int>(width), static_cast<int>(height)};
}

PictureHeader read_png(std::string_view bytes) {
    ByteReader reader(bytes, png_signature.size());
    if (reader.u32_big() != 13 || reader.take(4) != "IHDR") throw AssetError("the PNG does not begin with a header");
    const std::uint32_t width = reader.u32_big(), height = reader.u32_big();
    const PictureHeader header = checked(PictureFormat::png, width, height);
    reader.skip(5 + 4);
    for (std::string_view chunk; chunk != "IEND";) {
        const std::uint32_t length = reader.u32_big();
        chunk = reader.take(4);
        reader.skip(std::size_t{length} + 4);
    }
    return header;
}

bool is_frame(int marker) {
    return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

/// The next marker; entropy-coded data, stuffed zeros and restart markers before it are passed.
int next_marker(ByteReader& reader) {
    while (true) {
        while (reader.u8() != 0xff) {
        }
        int marker = reader.u8();
        while (marker == 0xff) marker = reader.u8();
        const bool within_data = marker == 0 || (marker >= 0xd0 && marker <= 0xd7);
        if (!within_data) return marker;
    }
}

PictureHeader read_jpeg(std::string_view bytes) {
    constexpr int end_of_image = 0xd9;
    ByteReader reader(bytes, 2);
    PictureHeader header{.format = PictureFormat::jpeg};
    for (int marker = next_marker(reader); marker != end_of_image; marker = next_marker(reader)) {
        const std::size_t length = reader.u16_big();
        if (length < 2) throw AssetError("the JPEG has a segment without a length");
        ByteReader segment(reader.take(length - 2));
        if (!is_frame(marker)) continue;
        segment.skip(1);
        const std::uint16_t height = segment.u16_big(), width = segment.u16_big();
        header = checked(PictureFormat::jpeg, width, height);
        if (const int components = segment.u8(); components != 1 && components != 3)
            throw AssetError(fmt::format("the JPEG has {} components; grey and RGB are read, CMYK is not", components));
    }
    if (header.width_px == 0) throw AssetError("the JPEG has no frame header");
    return header;
}

PictureHeader read_exr(std::string_view bytes) {
    constexpr std::uint32_t deep = 0x800, several_parts = 0x1000;
    ByteReader reader(bytes, exr_signature.size());
    const std::uint32_t version = reader.u32_little();
    if ((version & (deep | several_parts)) != 0)
        throw AssetError("the OpenEXR file has deep data or several parts; only flat pictures of one part are read");
    while (true) {
        const std::string_view name = reader.zero_ended_text();
        if (name.empty()) throw AssetError("the OpenEXR file has no data window");
        reader.zero_ended_text();
        ByteReader value(reader.take(reader.u32_little()));
        if (name != "dataWindow") continue;
        std::int64_t corners[4];
        for (std::int64_t& corner : corners) corner = static_cast<std::int32_t>(value.u32_little());
        return checked(PictureFormat::exr, corners[2] - corners[0] + 1, corners[3] - corners[1] + 1);
    }
}

}  // namespace

const char* name_of(PictureFormat format) {
    if (format == PictureFormat::png) return "PNG";
    return format == PictureFormat::jpeg ? "JPEG" : "OpenEXR file";
}

PictureHeader read_picture_header(std::string_view bytes) {
    if (bytes.starts_with(png_signature)) return read_png(bytes);
    if (bytes.starts_with(jpeg_signature)) return read_jpeg(bytes);
    if (bytes.starts_with(exr_signature)) return read_exr(bytes);
    throw AssetError("the file is no PNG, JPEG or OpenEXR picture: its first bytes are those of none of them");
}

}  // namespace sheer
