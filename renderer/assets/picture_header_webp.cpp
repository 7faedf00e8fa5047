#include "renderer/assets/file_bytes.h"
#include "renderer/assets/picture_header_parts.h"

namespace sheer {

namespace {

PictureHeader webp_header(std::int64_t width, std::int64_t height) {
    check_picture_size(PictureFormat::webp, width, height);
    PictureHeader header{.format = PictureFormat::webp};
    header.width_px = static_cast<int>(width);
    header.height_px = static_cast<int>(height);
    return header;
}

std::uint32_t u24_little(ByteReader& reader) {
    const std::uint32_t low = reader.u8(), middle = reader.u8(), high = reader.u8();
    return low | middle << 8 | high << 16;
}

}  // namespace

/// RFC 9649, sections 2.3 to 2.7.
PictureHeader read_webp_header(std::string_view bytes) {
    constexpr std::uint8_t animated = 2, lossless_signature = 0x2f;
    constexpr std::uint32_t side_mask = 0x3fff;
    ByteReader reader(bytes, 4);
    if (reader.u32_little() + std::size_t{8} > bytes.size()) throw AssetError("the WebP is cut off");
    if (reader.take(4) != "WEBP") throw AssetError("the file is RIFF, but not a WebP picture");
    const std::string_view kind = reader.take(4);
    reader.skip(4);
    if (kind == "VP8X") {
        if ((reader.u8() & animated) != 0) throw AssetError("the WebP is animated; only single pictures are supported");
        reader.skip(3);
        const std::int64_t width = std::int64_t{u24_little(reader)} + 1, height = std::int64_t{u24_little(reader)} + 1;
        return webp_header(width, height);
    }
    if (kind == "VP8L" && reader.u8() == lossless_signature) {
        const std::uint32_t bits = reader.u32_little();
        return webp_header((bits & side_mask) + 1, (bits >> 14 & side_mask) + 1);
    }
    if (kind == "VP8 ") {
        reader.skip(3);
        if (reader.take(3) == "\x9d\x01\x2a") {
            const std::uint32_t sides = reader.u32_little();
            return webp_header(sides & side_mask, sides >> 16 & side_mask);
        }
    }
    throw AssetError("the WebP does not begin with a picture");
}

}  // namespace sheer
