// How unusual pictures are read: turned, cropped, odd, damaged. Files are written here chunk by chunk, or by
// OpenImageIO and then changed.
#include <gmock/gmock.h>

#include "renderer/assets/picture_file.h"
#include "tests/unit/asset_pictures.h"
#include "tests/unit/png_writer.h"

namespace sheer::picture_files_test {
namespace {

using namespace std::string_literals;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string refusal_of(const std::string& bytes) {
    try {
        read_picture(bytes, 4, 4);
        return "";
    } catch (const AssetError& error) {
        return error.what();
    }
}

std::vector<std::string> codes_of(const std::vector<Note>& notes) {
    std::vector<std::string> codes;
    for (const Note& note : notes) codes.push_back(note.code);
    return codes;
}

std::vector<std::string> codes_in(const std::string& bytes) {
    return codes_of(decode_picture(bytes, [](int, const float*) {}).notes);
}

/// Red, in levels of 8 bits, of all pixels by rows.
std::vector<int> reds_of(const Image& image) {
    std::vector<int> reds;
    for (std::size_t i = 0; i < image.pixel_count(); ++i)
        reds.push_back(static_cast<int>(image.rgba[4 * i] * 255 + 0.5f));
    return reds;
}

std::string replaced(std::string bytes, const std::string& what, const std::string& with) {
    const std::size_t at = bytes.find(what);
    EXPECT_NE(at, std::string::npos) << "nothing to replace";
    return bytes.replace(at, what.size(), with);
}

/// 3 x 2, gray: 10 20 30 / 40 50 60.
PngParts numbered() {
    return {.width_px = 3,
            .height_px = 2,
            .color_type = 0,
            .before_data = "",
            .rows = "\0\x0a\x14\x1e\0\x28\x32\x3c"s,
            .after = ""};
}

struct Turn {
    int orientation;
    std::vector<int> seen;
};

/// EXIF 2.3, 4.6.4 A: the positions at which the file's first row and first column are displayed.
const Turn turns[] = {{1, {10, 20, 30, 40, 50, 60}},   // top, left
                      {2, {30, 20, 10, 60, 50, 40}},   // top, right
                      {3, {60, 50, 40, 30, 20, 10}},   // bottom, right
                      {4, {40, 50, 60, 10, 20, 30}},   // bottom, left
                      {5, {10, 40, 20, 50, 30, 60}},   // left, top
                      {6, {40, 10, 50, 20, 60, 30}},   // right, top
                      {7, {60, 30, 50, 20, 40, 10}},   // right, bottom
                      {8, {30, 60, 20, 50, 10, 40}}};  // left, bottom

TEST(Orientation, OfAPngTurnsIt) {
    for (const Turn& turn : turns) {
        for (const bool big_endian : {false, true}) {
            PngParts parts = numbered();
            parts.before_data = png_chunk("eXIf", exif_of(turn.orientation, big_endian));
            const PictureHeader header = read_picture_header(png_of(parts));
            EXPECT_EQ(header.width_px, turn.orientation < 5 ? 3 : 2);
            EXPECT_EQ(header.height_px, turn.orientation < 5 ? 2 : 3);
            const Picture picture = read_picture(png_of(parts), header.width_px, header.height_px);
            EXPECT_EQ(reds_of(picture.image), turn.seen) << turn.orientation;
            EXPECT_EQ(codes_of(picture.notes), turn.orientation == 1 ? std::vector<std::string>{}
                                                                     : std::vector<std::string>{"orientation-applied"});
        }
    }
}

std::string with_exif(const std::string& jpeg, const std::string& tiff) {
    const std::string data = "Exif\0\0"s + tiff;
    const std::size_t length = data.size() + 2;
    return jpeg.substr(0, 2) + "\xff\xe1" + static_cast<char>(length >> 8) + static_cast<char>(length & 255) + data +
           jpeg.substr(2);
}

/// OpenImageIO writes its own EXIF after ours; remove it by its marker's name.
std::string jpeg_of(int width_px, int height_px, int channels, const std::vector<std::uint8_t>& values,
                    bool progressive = false) {
    OIIO::ImageSpec spec(width_px, height_px, channels, OIIO::TypeDesc::UINT8);
    spec.attribute("jpeg:subsampling", "4:4:4");
    spec.attribute("CompressionQuality", 100);
    spec.attribute("jpeg:progressive", progressive ? 1 : 0);
    const auto output = OIIO::ImageOutput::create("jpeg");
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    EXPECT_TRUE(output && output->set_ioproxy(&memory) && output->open("picture.jpeg", spec) &&
                output->write_image(OIIO::TypeDesc::UINT8, values.data()) && output->close());
    const std::string jpeg(bytes.begin(), bytes.end());
    return replaced(jpeg, "Exif\0\0"s, "Other\0"s);
}

TEST(Orientation, OfAJpegTurnsIt) {
    // Left half dark, right half bright: the file's first row is displayed on the right, so dark is at the top.
    std::vector<std::uint8_t> values;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 32; ++x) values.push_back(x < 16 ? 40 : 200);
    const std::string jpeg = with_exif(jpeg_of(32, 16, 1, values), exif_of(6, true));
    const PictureHeader header = read_picture_header(jpeg);
    EXPECT_EQ(header.width_px, 16);
    EXPECT_EQ(header.height_px, 32);
    const Picture picture = read_picture(jpeg, 1, 2);
    EXPECT_NEAR(picture.image.pixel(0, 0)[0], 40 / 255.0f, 2 / 255.0f);
    EXPECT_NEAR(picture.image.pixel(0, 1)[0], 200 / 255.0f, 2 / 255.0f);
}

TEST(Orientation, IsIgnoredIfMalformed) {
    const std::string whole = exif_of(6, false);
    std::vector<std::string> broken = {"", "II", exif_of(0, false), exif_of(9, true), "II*\0\xff\xff\xff\xff"s};
    for (const std::size_t length : {9, 12, 24}) broken.push_back(whole.substr(0, length));
    for (const std::string& tiff : broken) {
        PngParts parts = numbered();
        parts.before_data = png_chunk("eXIf", tiff);
        EXPECT_EQ(read_picture_header(png_of(parts)).orientation, 1) << tiff.size();
    }
}

TEST(Png, OfFewBitsWithAPaletteAndTransparencyIsRead) {
    // Two bits a pixel: entries 0, 1, 2, 1; entry 1 is transparent to 51 of 255.
    const PngParts parts = {
        .width_px = 4,
        .depth = 2,
        .color_type = 3,
        .before_data = png_chunk("PLTE", "\x0a\x01\x02\x14\x03\x04\x1e\x05\x06") + png_chunk("tRNS", "\xff\x33"),
        .rows = "\0\x19"s,
        .after = ""};
    const Picture picture = read_picture(png_of(parts), 4, 1);
    EXPECT_THAT(reds_of(picture.image), ElementsAre(10, 20, 30, 20));
    EXPECT_FLOAT_EQ(picture.image.pixel(0, 0)[3], 1);
    EXPECT_FLOAT_EQ(picture.image.pixel(1, 0)[3], 0.2f);
    EXPECT_FLOAT_EQ(picture.image.pixel(2, 0)[3], 1);
    EXPECT_FLOAT_EQ(picture.image.pixel(3, 0)[3], 0.2f);
    EXPECT_THAT(picture.notes, IsEmpty());
}

TEST(Png, OfSixteenBitsWithATransparentColorIsRead) {
    PngParts parts = {.width_px = 2,
                      .depth = 16,
                      .color_type = 0,
                      .before_data = png_chunk("tRNS", "\x12\x34"),
                      .rows = "\0\x12\x34\x12\x35"s,
                      .after = ""};
    const Picture picture = read_picture(png_of(parts), 2, 1);
    EXPECT_FALSE(picture.eight_bit);
    EXPECT_FLOAT_EQ(picture.image.pixel(0, 0)[3], 0);
    EXPECT_FLOAT_EQ(picture.image.pixel(1, 0)[3], 1);
    EXPECT_FLOAT_EQ(picture.image.pixel(1, 0)[0], 0x1235 / 65535.0f);
}

/// Adam7 sends the pixels of a 3 x 2 picture as (0,0), none, none, (2,0), none, (1,0), then row 1.
TEST(Png, ThatIsInterlacedIsRead) {
    PngParts parts = numbered();
    parts.interlaced = true;
    parts.rows = "\0\x0a\0\x1e\0\x14\0\x28\x32\x3c"s;
    EXPECT_THAT(reds_of(read_picture(png_of(parts), 3, 2).image), ElementsAre(10, 20, 30, 40, 50, 60));
    parts.rows.pop_back();
    EXPECT_THAT(refusal_of(png_of(parts)), HasSubstr("ends too early"));
}

TEST(Png, WithoutAllOfItsDataIsRefused) {
    PngParts parts = numbered();
    parts.rows.pop_back();
    EXPECT_THAT(refusal_of(png_of(parts)), AllOf(HasSubstr("PNG cannot be decoded"), HasSubstr("ends too early")));
    parts.rows.clear();
    EXPECT_THAT(refusal_of(png_of(parts)), HasSubstr("ends too early"));
    const std::string whole = png_of(numbered());
    const std::size_t data = whole.find("IDAT") - 4;
    EXPECT_THAT(refusal_of(whole.substr(0, data) + png_chunk("IEND", "")), HasSubstr("ends too early"));
}

/// A wrong zlib checksum, with a corrected checksum of the chunk: libpng accepts it.
TEST(Png, WhoseDataHasAnotherChecksumIsRefused) {
    const std::string whole = png_of(numbered());
    std::string packed = deflated(numbered().rows);
    packed.back() = static_cast<char>(packed.back() ^ 1);
    const std::size_t data = whole.find("IDAT") - 4;
    EXPECT_THAT(refusal_of(whole.substr(0, data) + png_chunk("IDAT", packed) + png_chunk("IEND", "")),
                HasSubstr("image data is damaged"));
}

/// Also for an ancillary chunk: without its tRNS chunk a picture looks different.
TEST(Png, WithAWrongChecksumIsRefused) {
    PngParts parts = numbered();
    parts.before_data = png_chunk("tRNS", "\0\x0a"s);
    for (const char* chunk : {"IHDR", "tRNS", "IDAT", "IEND"}) {
        std::string png = png_of(parts);
        ASSERT_EQ(refusal_of(png), "");
        const std::size_t name = png.find(chunk), length = static_cast<std::uint8_t>(png[name - 1]);
        png[name + 4 + length] = static_cast<char>(png[name + 4 + length] ^ 4);
        EXPECT_THAT(refusal_of(png), HasSubstr("checksum")) << chunk;
    }
}

std::string chrm_of(const std::vector<double>& white_first) {
    std::string data;
    for (const double number : white_first) data += u32_big(static_cast<std::uint32_t>(number * 1e5 + 0.5));
    return png_chunk("cHRM", data);
}

TEST(Png, SaysWhichPartsAreNotRead) {
    const std::vector<double> rec_709 = {0.3127, 0.329, 0.64, 0.33, 0.3, 0.6, 0.15, 0.06};
    const std::vector<double> adobe = {0.3127, 0.329, 0.64, 0.33, 0.21, 0.71, 0.15, 0.06};
    const std::string linear = png_chunk("gAMA", u32_big(100000)), srgb = png_chunk("sRGB", "\0"s);
    const auto codes = [](const std::string& before, const std::string& after = "") {
        PngParts parts = numbered();
        parts.before_data = before;
        parts.after = after;
        return codes_in(png_of(parts));
    };
    EXPECT_THAT(codes(png_chunk("gAMA", u32_big(45455)) + chrm_of(rec_709)), IsEmpty());
    EXPECT_THAT(codes(linear), ElementsAre("gamma-ignored"));
    EXPECT_THAT(codes(chrm_of(adobe)), ElementsAre("chromaticities-ignored"));
    EXPECT_THAT(codes(srgb + linear + chrm_of(adobe)), IsEmpty()) << "sRGB overrules them";
    EXPECT_THAT(codes(png_chunk("acTL", u32_big(2) + u32_big(0))), ElementsAre("animation-ignored"));
    EXPECT_THAT(codes("", "left over"), ElementsAre("trailing-bytes"));
    PngParts longer = numbered();
    longer.rows += "\0\x0a\x14\x1e"s;
    EXPECT_THAT(codes_in(png_of(longer)), ElementsAre("image-data-ignored"));
}

std::vector<std::uint8_t> waves(int side) {
    std::vector<std::uint8_t> values;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            for (int channel = 0; channel < 3; ++channel)
                values.push_back(static_cast<std::uint8_t>((x * 7 + y * 13 + x * y * (channel + 1)) & 255));
    return values;
}

/// Where the entropy-coded data of each scan begins and ends.
std::vector<std::pair<std::size_t, std::size_t>> scans_of(const std::string& jpeg) {
    std::vector<std::pair<std::size_t, std::size_t>> scans;
    for (std::size_t at = jpeg.find("\xff\xda"); at != std::string::npos; at = jpeg.find("\xff\xda", at + 1)) {
        std::size_t end = at + 2 + static_cast<std::uint8_t>(jpeg[at + 3]);
        const std::size_t begin = end;
        while (jpeg[end] != '\xff' || jpeg[end + 1] == '\0') ++end;
        scans.emplace_back(begin, end);
    }
    return scans;
}

/// From there on a decoder draws gray and reports success.
TEST(Jpeg, WithATruncatedScanIsRefused) {
    for (const bool progressive : {false, true}) {
        const std::string jpeg = jpeg_of(64, 64, 3, waves(64), progressive);
        ASSERT_EQ(refusal_of(jpeg), "");
        const auto scans = scans_of(jpeg);
        ASSERT_EQ(scans.size() > 1, progressive);
        for (const auto& [begin, end] : scans)
            for (const double part : {0.0, 0.3, 0.9}) {
                auto left = static_cast<std::size_t>(part * static_cast<double>(end - begin));
                if (left > 0 && jpeg[begin + left - 1] == '\xff') --left;
                if (end - begin - left < 3) continue;
                EXPECT_THAT(refusal_of(jpeg.substr(0, begin + left) + jpeg.substr(end)),
                            HasSubstr("JPEG cannot be decoded"))
                    << part << " of " << end - begin << " bytes of a scan";
            }
    }
}

TEST(Jpeg, ThatLacksScansIsRefused) {
    const std::string jpeg = jpeg_of(64, 64, 3, waves(64), true);
    const auto scans = scans_of(jpeg);
    for (std::size_t i = 0; i + 1 < scans.size(); ++i)
        EXPECT_THAT(refusal_of(jpeg.substr(0, scans[i].second) + "\xff\xd9"), HasSubstr("ends too early")) << i;
    EXPECT_EQ(refusal_of(jpeg.substr(0, scans.back().second) + "\xff\xd9"), "");
}

TEST(Jpeg, WithLessDataThanDeclaredIsRefused) {
    std::string jpeg = jpeg_of(16, 16, 3, waves(16));
    jpeg = replaced(jpeg, "\xff\xc0\x00\x11\x08\x00\x10\x00\x10"s, "\xff\xc0\x00\x11\x08\x10\x00\x10\x00"s);
    EXPECT_THAT(refusal_of(jpeg), HasSubstr("JPEG cannot be decoded"));
}

TEST(Jpeg, OfOtherKindsIsRefusedByName) {
    const std::string jpeg = jpeg_of(16, 16, 3, waves(16));
    const std::string frame = "\xff\xc0\x00\x11\x08"s;
    EXPECT_THAT(refusal_of(replaced(jpeg, frame, "\xff\xc3\x00\x11\x08"s)), HasSubstr("lossless"));
    EXPECT_THAT(refusal_of(replaced(jpeg, frame, "\xff\xc5\x00\x11\x08"s)), HasSubstr("hierarchical"));
    EXPECT_THAT(refusal_of(replaced(jpeg, frame, "\xff\xc1\x00\x11\x0c"s)), HasSubstr("12 bits per channel"));
    const std::string four = "\xff\xc0\x00\x14\x08\x00\x10\x00\x10\x04"s;
    EXPECT_THAT(refusal_of(replaced(jpeg, "\xff\xc0\x00\x11\x08\x00\x10\x00\x10\x03"s, four)), HasSubstr("CMYK"));
}

TEST(Jpeg, WithExtraBytesIsReadWithANote) {
    const std::string jpeg = jpeg_of(16, 16, 3, waves(16));
    EXPECT_THAT(codes_in(jpeg), IsEmpty());
    EXPECT_THAT(codes_in(jpeg + "more"), ElementsAre("trailing-bytes"));
    const std::string frame = "\xff\xc0\x00\x11\x08"s;
    const Picture padded = read_picture(replaced(jpeg, frame, "\x01\x02" + frame), 16, 16);
    EXPECT_THAT(codes_of(padded.notes), ElementsAre("decoder-warning"));
    EXPECT_EQ(padded.image.rgba, read_picture(jpeg, 16, 16).image.rgba);
}

struct ExrParts {
    int x = 0, y = 0, width_px = 2, height_px = 2;  ///< the data window
    int full_x = 0, full_y = 0, full_width_px = 2, full_height_px = 2;
    std::vector<std::string> channels = {"R", "G", "B"};
    OIIO::TypeDesc type = OIIO::TypeDesc::FLOAT;
    std::vector<float> chromaticities;
    int tile_px = 0;
};

/// The pixels have the values 1, 2, 3 ... in row order, in each channel.
std::string exr_of(const ExrParts& parts) {
    OIIO::ImageSpec spec(parts.width_px, parts.height_px, static_cast<int>(parts.channels.size()), parts.type);
    spec.x = parts.x;
    spec.y = parts.y;
    spec.full_x = parts.full_x;
    spec.full_y = parts.full_y;
    spec.full_width = parts.full_width_px;
    spec.full_height = parts.full_height_px;
    spec.channelnames = parts.channels;
    spec.alpha_channel = -1;
    spec.tile_width = spec.tile_height = parts.tile_px;
    if (!parts.chromaticities.empty())
        spec.attribute("chromaticities", OIIO::TypeDesc("float[8]"), parts.chromaticities.data());
    std::vector<float> values;
    for (int i = 1; i <= parts.width_px * parts.height_px; ++i)
        values.insert(values.end(), parts.channels.size(), static_cast<float>(i));
    const auto output = OIIO::ImageOutput::create("openexr");
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    EXPECT_TRUE(output && output->set_ioproxy(&memory) && output->open("picture.exr", spec) &&
                output->write_image(OIIO::TypeDesc::FLOAT, values.data()) && output->close())
        << output->geterror();
    return {bytes.begin(), bytes.end()};
}

/// Red and alpha of all pixels, at the display window's own size.
std::vector<float> reds_and_alphas(const std::string& exr) {
    const PictureHeader header = read_picture_header(exr);
    const Picture picture = read_picture(exr, header.width_px, header.height_px);
    std::vector<float> found;
    for (std::size_t i = 0; i < picture.image.pixel_count(); ++i) {
        found.push_back(picture.image.rgba[4 * i]);
        found.push_back(picture.image.rgba[4 * i + 3]);
    }
    return found;
}

TEST(Exr, OfFewerPixelsThanItsDisplayWindowIsTransparentBeside) {
    for (const int tile_px : {0, 16}) {
        // 2 x 1 pixels at (-1, 7), in a window of 4 x 2 from (-2, 6).
        const ExrParts parts = {.x = -1,
                                .y = 7,
                                .width_px = 2,
                                .height_px = 1,
                                .full_x = -2,
                                .full_y = 6,
                                .full_width_px = 4,
                                .full_height_px = 2,
                                .tile_px = tile_px};
        EXPECT_THAT(reds_and_alphas(exr_of(parts)), ElementsAre(0, 0, 0, 0, 0, 0, 0, 0,  //
                                                                0, 0, 1, 1, 2, 1, 0, 0));
        EXPECT_THAT(codes_in(exr_of(parts)), IsEmpty());
    }
}

TEST(Exr, OfMorePixelsThanItsDisplayWindowIsCutWithANote) {
    // 1..9 from (-1, -1), seen from (0, 0) on: 5 6 / 8 9.
    const ExrParts parts = {.x = -1, .y = -1, .width_px = 3, .height_px = 3};
    EXPECT_THAT(reds_and_alphas(exr_of(parts)), ElementsAre(5, 1, 6, 1, 8, 1, 9, 1));
    EXPECT_THAT(codes_in(exr_of(parts)), ElementsAre("outside-display-window"));
}

TEST(Exr, BesideItsDisplayWindowIsEmpty) {
    const ExrParts parts = {.x = 40, .y = -30, .full_width_px = 2, .full_height_px = 1};
    EXPECT_THAT(reds_and_alphas(exr_of(parts)), ElementsAre(0, 0, 0, 0));
    EXPECT_THAT(codes_in(exr_of(parts)), ElementsAre("outside-display-window"));
}

TEST(Exr, OfHugeDisplayWindowsIsRefused) {
    EXPECT_THAT(refusal_of(exr_of({.full_width_px = 8193})), HasSubstr("8193 x 2"));
    EXPECT_THAT(refusal_of(exr_of({.width_px = 8200, .height_px = 1})), HasSubstr("8200 x 1"));
}

TEST(Exr, SaysWhichChannelsItHas) {
    EXPECT_THAT(codes_in(exr_of({.channels = {"R", "G", "B", "Z", "left.R"}})), ElementsAre("channels-ignored"));
    EXPECT_THAT(codes_in(exr_of({.channels = {"Y"}})), IsEmpty());
    EXPECT_THAT(refusal_of(exr_of({.channels = {"beauty.R", "beauty.G", "beauty.B"}})), HasSubstr("beauty.B"));
    EXPECT_THAT(refusal_of(exr_of({.channels = {"Z"}})), HasSubstr("channels Z;"));
    EXPECT_THAT(refusal_of(exr_of({.channels = {"Y", "RY", "BY"}})), HasSubstr("luminance and chroma"));
    EXPECT_THAT(refusal_of(exr_of({.type = OIIO::TypeDesc::UINT32})), HasSubstr("whole numbers"));
}

TEST(Exr, OfOtherPrimariesHasANote) {
    EXPECT_THAT(codes_in(exr_of({.chromaticities = {0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f}})),
                IsEmpty());
    // ACES AP0.
    EXPECT_THAT(codes_in(exr_of({.chromaticities = {0.7347f, 0.2653f, 0, 1, 0.0001f, -0.077f, 0.32168f, 0.33767f}})),
                ElementsAre("chromaticities-ignored"));
}

TEST(Exr, WithValuesThatCannotBeDrawnHasANote) {
    const auto codes = [](std::vector<float> rgba) { return codes_in(encode_picture("openexr", 1, 1, 4, rgba)); };
    EXPECT_THAT(codes({3, 0, 0, 1}), IsEmpty());
    EXPECT_THAT(codes({-0.5f, 0, 0, 1}), ElementsAre("values-clamped"));
    EXPECT_THAT(codes({0, 0, 0, 1.5f}), ElementsAre("values-clamped"));
}

}  // namespace
}  // namespace sheer::picture_files_test
