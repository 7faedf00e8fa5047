#include "renderer/pictures/picture_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace sheer {

namespace {

/// `format` names the writer: "png" or "openexr".
std::string encode(const std::string& format, const OIIO::ImageSpec& spec, const OIIO::TypeDesc& type,
                   const void* pixels) {
    const auto output = OIIO::ImageOutput::create(format);
    if (!output) throw std::runtime_error("no writer for " + format + ": " + OIIO::geterror());
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    if (!output->supports("ioproxy") || !output->set_ioproxy(&memory) || !output->open("picture." + format, spec) ||
        !output->write_image(type, pixels) || !output->close())
        throw std::runtime_error("cannot write " + format + ": " + output->geterror());
    return {bytes.begin(), bytes.end()};
}

Image8 read_rgb(OIIO::ImageInput& input, const std::string& name) {
    const OIIO::ImageSpec& spec = input.spec();
    Image8 image(spec.width, spec.height);
    if (spec.nchannels < 3 || !input.read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, image.rgb.data()))
        throw std::runtime_error("cannot read " + name + " as RGB: " + input.geterror());
    return image;
}

std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = at; i < at + 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
    return value;
}

std::string encode_floats(int width_px, int height_px, int channels, const float* values) {
    OIIO::ImageSpec spec(width_px, height_px, channels, OIIO::TypeDesc::FLOAT);
    spec.attribute("compression", "zip");
    // Without a date the writer would store the current time, and the same pixels would give different bytes.
    spec.attribute("DateTime", "1970:01:01 00:00:00");
    return encode("openexr", spec, OIIO::TypeDesc::FLOAT, values);
}

}  // namespace

std::string encode_png(const Image8& image) {
    OIIO::ImageSpec spec(image.width_px, image.height_px, 3, OIIO::TypeDesc::UINT8);
    spec.attribute("png:compressionLevel", 4);  // a third of the time of level 9 for a few percent more bytes
    return encode("png", spec, OIIO::TypeDesc::UINT8, image.rgb.data());
}

std::string encode_jpeg(const Image8& image) {
    OIIO::ImageSpec spec(image.width_px, image.height_px, 3, OIIO::TypeDesc::UINT8);
    spec.attribute("CompressionQuality", 90);
    return encode("jpeg", spec, OIIO::TypeDesc::UINT8, image.rgb.data());
}

std::string encode_exr(const Image& image) {
    return encode_floats(image.width_px, image.height_px, 4, image.rgba.data());
}

std::string encode_exr(const PixelCounts& counts) {
    const std::vector<float> values(counts.counts.begin(), counts.counts.end());
    return encode_floats(counts.width_px, counts.height_px, 1, values.data());
}

Image8 read_png(const std::string& path) {
    const auto input = OIIO::ImageInput::open(path);
    if (!input) throw std::runtime_error("cannot read " + path + ": " + OIIO::geterror());
    return read_rgb(*input, path);
}

Image8 decode_png(const std::string& bytes, int width_px, int height_px) {
    const std::string signature("\x89PNG\r\n\x1a\n");
    constexpr std::size_t width_at = 16, height_at = 20, header_bytes = 24;
    if (bytes.size() < header_bytes || !bytes.starts_with(signature))
        throw std::runtime_error("a picture is not a PNG file");
    if (big_endian(bytes, width_at) != static_cast<std::uint32_t>(width_px) ||
        big_endian(bytes, height_at) != static_cast<std::uint32_t>(height_px))
        throw std::runtime_error("a picture does not have the size given in its report");
    OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
    const auto input = OIIO::ImageInput::create("png");
    if (!input) throw std::runtime_error("no reader for PNG: " + OIIO::geterror());
    OIIO::ImageSpec spec;
    if (!input->set_ioproxy(&memory) || !input->open("picture.png", spec))
        throw std::runtime_error("cannot read a picture: " + input->geterror());
    return read_rgb(*input, "a picture");
}

std::array<double, 3> read_pixel(const std::string& bytes, int x, int y) {
    const bool is_png = bytes.starts_with("\x89PNG");
    OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
    const auto input = OIIO::ImageInput::create(is_png ? "png" : "openexr");
    if (!input) throw std::runtime_error("no reader for pictures: " + OIIO::geterror());
    OIIO::ImageSpec spec;
    if (!input->set_ioproxy(&memory) || !input->open("picture", spec))
        throw std::runtime_error("cannot read a picture: " + input->geterror());
    if (x < 0 || y < 0 || x >= spec.width || y >= spec.height) throw std::runtime_error("a picture has no such pixel");
    const int channels = std::min(spec.nchannels, 3);
    std::vector<float> row(static_cast<std::size_t>(spec.width) * channels);
    if (!input->read_scanlines(0, 0, y, y + 1, 0, 0, channels, OIIO::TypeDesc::FLOAT, row.data()))
        throw std::runtime_error("cannot read a picture: " + input->geterror());
    const float* pixel = &row[static_cast<std::size_t>(x) * channels];
    std::array<double, 3> value{};
    // 8-bit values are read as the nearest floats; the level itself is exact.
    for (int i = 0; i < channels; ++i) value[i] = is_png ? std::round(pixel[i] * 255.0) / 255.0 : double{pixel[i]};
    return value;
}

}  // namespace sheer
