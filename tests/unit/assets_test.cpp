#include <gmock/gmock.h>

#include <limits>

#include "renderer/assets/check_asset.h"
#include "renderer/scene/asset_kinds.h"

#include "renderer/assets/file_assets.h"
#include "renderer/assets/picture_file.h"
#include "renderer/assets/scaler.h"
#include "renderer/core/sha256.h"
#include "tests/unit/asset_pictures.h"
#include "tests/unit/temporary_folder.h"

namespace sheer::assets_test {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;

/// The reason for which `work` refuses; "" if it does not.
template <typename Work>
std::string refusal(const Work& work) {
    try {
        work();
        return "";
    } catch (const AssetError& error) {
        return error.what();
    }
}

std::string read_refusal(const std::string& bytes) {
    return refusal([&] { read_picture(bytes, 4, 4); });
}

void expect_pixel(const Image& image, int x, int y, const std::vector<float>& expected) {
    for (int channel = 0; channel < 4; ++channel)
        EXPECT_NEAR(image.pixel(x, y)[channel], expected[static_cast<std::size_t>(channel)], 1e-6)
            << "channel " << channel << " at " << x << ", " << y;
}

Image scaled(const Image& source, int width, int height) {
    Scaler scaler(source.width_px, source.height_px, width, height);
    for (int y = 0; y < source.height_px; ++y) scaler.add_row(y, source.pixel(0, y));
    return scaler.finish();
}

Image image_of(int width, int height, std::vector<float> rgba) {
    Image image(width, height);
    image.rgba = std::move(rgba);
    return image;
}

TEST(Scaler, WeightsColorsByAlpha) {
    // Opaque red, half green, transparent blue twice: alpha (1 + 0.5) / 4, colors (1, 0.5, 0) / 1.5.
    const Image source = image_of(2, 2, {1, 0, 0, 1, 0, 1, 0, 0.5, 0, 0, 1, 0, 0, 0, 1, 0});
    expect_pixel(scaled(source, 1, 1), 0, 0, {1 / 1.5f, 0.5f / 1.5f, 0, 0.375f});
}

TEST(Scaler, KeepsAColorWithAnAlphaOfZero) {
    const Image source = image_of(2, 1, {1, 0, 0, 0, 0, 1, 0, 0});
    expect_pixel(scaled(source, 1, 1), 0, 0, {0.5f, 0.5f, 0, 0});
}

TEST(Scaler, AveragesTheAreaOfATargetPixel) {
    // Three pixels to two: the first covers pixel 0 and half of pixel 1, so (0 + 0.5 * 0.3) / 1.5 = 0.1.
    const Image source = image_of(3, 1, {0, 0, 0, 1, 0.3f, 0, 0, 1, 0.9f, 0, 0, 1});
    const Image result = scaled(source, 2, 1);
    expect_pixel(result, 0, 0, {0.1f, 0, 0, 1});
    expect_pixel(result, 1, 0, {(0.15f + 0.9f) / 1.5f, 0, 0, 1});
}

TEST(Scaler, GrowsByCatmullRom) {
    // Two pixels to four: centers at -0.25, 0.25, 0.75, 1.25. At 0.25 the weights of pixels -1, 0, 1, 2 are -0.0703125,
    // 0.8671875, 0.2265625, -0.0234375; the outermost pixels are repeated, so pixel 1 has the weight 0.203125. At -0.25
    // the pixels -2, -1, 0 are the first one and pixel 1 has the weight -0.0703125: under 0, and so 0.
    const Image source = image_of(2, 1, {0, 0, 0, 1, 1, 0, 0, 1});
    const Image result = scaled(source, 4, 1);
    expect_pixel(result, 0, 0, {0, 0, 0, 1});
    expect_pixel(result, 1, 0, {0.203125f, 0, 0, 1});
    expect_pixel(result, 2, 0, {0.796875f, 0, 0, 1});
    expect_pixel(result, 3, 0, {1.0703125f, 0, 0, 1});
}

TEST(Scaler, LeavesAPictureOfTheSameSizeUnchanged) {
    const Image source = image_of(2, 2, {0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f, 0.7f, 1, 7, 0, 0, 0, 0, 9, 0, 0.01f});
    const Image result = scaled(source, 2, 2);
    for (std::size_t i = 0; i < source.rgba.size(); ++i) EXPECT_FLOAT_EQ(result.rgba[i], source.rgba[i]) << i;
}

TEST(ReadPicture, KeepsThePixelsOfAPng) {
    const std::string rgba = encode_picture<std::uint8_t>("png", 2, 2, 4,
                                                          {255, 0, 0, 255, 0, 51, 0, 102,  //
                                                           0, 0, 255, 0, 10, 20, 30, 255});
    const Picture picture = read_picture(rgba, 2, 2);
    EXPECT_TRUE(picture.eight_bit);
    expect_pixel(picture.image, 0, 0, {1, 0, 0, 1});
    expect_pixel(picture.image, 1, 0, {0, 0.2f, 0, 0.4f});
    expect_pixel(picture.image, 0, 1, {0, 0, 1, 0});
    expect_pixel(picture.image, 1, 1, {10 / 255.0f, 20 / 255.0f, 30 / 255.0f, 1});
}

TEST(ReadPicture, AcceptsGrayAndRgb) {
    const std::string grey = encode_picture<std::uint8_t>("png", 2, 1, 1, {51, 204});
    expect_pixel(read_picture(grey, 2, 1).image, 1, 0, {0.8f, 0.8f, 0.8f, 1});
    const std::string grey_alpha = encode_picture<std::uint8_t>("png", 1, 1, 2, {51, 102});
    expect_pixel(read_picture(grey_alpha, 1, 1).image, 0, 0, {0.2f, 0.2f, 0.2f, 0.4f});
    const std::string rgb = encode_picture<std::uint8_t>("png", 1, 1, 3, {51, 102, 153});
    expect_pixel(read_picture(rgb, 1, 1).image, 0, 0, {0.2f, 0.4f, 0.6f, 1});
}

TEST(ReadPicture, KeepsSixteenBits) {
    const std::string png = encode_picture<std::uint16_t>("png", 1, 1, 3, {1, 256, 65535});
    const Picture picture = read_picture(png, 1, 1);
    EXPECT_FALSE(picture.eight_bit);
    expect_pixel(picture.image, 0, 0, {1 / 65535.0f, 256 / 65535.0f, 1, 1});
}

TEST(ReadPicture, DividesTheColorsOfAnExrByTheirAlpha) {
    const std::vector<float> premultiplied = {2, 0.5f, 0, 0.5f, 3, 0, 0, 0};
    for (const int tile_px : {0, 16}) {
        const Picture picture = read_picture(encode_picture<float>("openexr", 2, 1, 4, premultiplied, tile_px), 2, 1);
        EXPECT_FALSE(picture.eight_bit);
        expect_pixel(picture.image, 0, 0, {4, 1, 0, 0.5f});
        expect_pixel(picture.image, 1, 0, {3, 0, 0, 0});
    }
}

TEST(ReadPicture, ClampsColorsToTheRangeOfATexture) {
    const Picture bright = read_picture(encode_picture<float>("openexr", 1, 1, 3, {1e30f, -1, 2}), 1, 1);
    expect_pixel(bright.image, 0, 0, {65504, 0, 2, 1});
    // Enlarging overshoots beside an edge; see Scaler.GrowsByCatmullRom.
    const Picture edge = read_picture(encode_picture<std::uint8_t>("png", 2, 1, 3, {0, 0, 0, 255, 255, 255}), 4, 1);
    expect_pixel(edge.image, 3, 0, {1, 1, 1, 1});
}

TEST(ReadPicture, ReadsAJpeg) {
    std::vector<std::uint8_t> values;
    for (int i = 0; i < 16 * 16; ++i) values.insert(values.end(), {200, 100, 50});
    const Picture picture = read_picture(encode_picture("jpeg", 16, 16, 3, values), 1, 1);
    EXPECT_TRUE(picture.eight_bit);
    EXPECT_NEAR(picture.image.rgba[0], 200 / 255.0f, 2 / 255.0f);
    EXPECT_NEAR(picture.image.rgba[1], 100 / 255.0f, 2 / 255.0f);
    EXPECT_NEAR(picture.image.rgba[2], 50 / 255.0f, 2 / 255.0f);
    EXPECT_FLOAT_EQ(picture.image.rgba[3], 1);
}

// With such a size the decoder takes minutes, or crashes.
TEST(ReadPicture, RefusesAHugeSizeAtOnce) {
    const std::string small = encode_picture<std::uint8_t>("png", 16, 16, 4, noise(16 * 16 * 4));
    ASSERT_LT(small.size(), 1200u);
    EXPECT_THAT(read_refusal(with_png_size(small, 60000, 60000)), HasSubstr("60000 x 60000"));
    EXPECT_THAT(read_refusal(with_png_size(small, 16, 0x80000000u)), HasSubstr("16 x 2147483648"));
    EXPECT_THAT(read_refusal(with_png_size(small, 0, 16)), HasSubstr("0 x 16"));

    std::string jpeg = encode_picture<std::uint8_t>("jpeg", 16, 16, 3, noise(16 * 16 * 3));
    std::size_t frame = jpeg.find(std::string("\xff\xc0\x00\x11", 4));
    ASSERT_NE(frame, std::string::npos);
    jpeg.replace(frame + 5, 4, "\xff\xff\xff\xff");
    EXPECT_THAT(read_refusal(jpeg), HasSubstr("65535 x 65535"));

    std::string exr = encode_picture<float>("openexr", 1, 1, 3, {1, 2, 3});
    const std::size_t window = exr.find(std::string("dataWindow\0box2i\0", 17)) + 17 + 4 + 8;
    exr.replace(window, 4, std::string("\xff\xff\xff\x7f", 4));
    EXPECT_THAT(read_refusal(exr), HasSubstr("2147483648 x 1"));
}

TEST(ReadPicture, RefusesAFileThatIsCutOff) {
    const std::vector<std::uint8_t> pixels = noise(64 * 64 * 3);
    std::vector<float> floats(pixels.begin(), pixels.end());
    for (const std::string& whole :
         {encode_picture("png", 64, 64, 3, pixels), encode_picture("jpeg", 64, 64, 3, pixels),
          encode_picture("openexr", 64, 64, 3, floats)}) {
        ASSERT_EQ(read_refusal(whole), "");
        for (const double part : {0.02, 0.3, 0.6, 0.9, 0.99})
            EXPECT_NE(read_refusal(whole.substr(0, static_cast<std::size_t>(part * static_cast<double>(whole.size())))),
                      "")
                << part << " of " << whole.substr(1, 3);
    }
}

TEST(ReadPicture, RefusesDamageInside) {
    std::string png = encode_picture<std::uint8_t>("png", 16, 16, 4, noise(16 * 16 * 4));
    png[png.size() / 2] = static_cast<char>(png[png.size() / 2] + 1);
    EXPECT_THAT(read_refusal(png), HasSubstr("PNG cannot be decoded"));
    EXPECT_THAT(read_refusal(with_png_size(encode_picture<std::uint8_t>("png", 16, 16, 4, noise(16 * 16 * 4)), 16, 64)),
                HasSubstr("PNG cannot be decoded"));
}

TEST(ReadPicture, RefusesOtherFormats) {
    for (const std::string& bytes : {std::string("GIF89a"), std::string("II*\0", 4), std::string("P6 1 1 255 abc"),
                                     std::string("x"), std::string("<svg/>")})
        EXPECT_THAT(read_refusal(bytes), HasSubstr("not a PNG, JPEG, OpenEXR"));
}

TEST(ReadPicture, RefusesPixelsThatAreNotFinite) {
    for (const float bad : {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()})
        EXPECT_THAT(read_refusal(encode_picture<float>("openexr", 2, 1, 3, {0, 0, 0, 0, bad, 0})), HasSubstr("finite"));
}

TEST(ReadPicture, RefusesAnExrOfSeveralPartsOrDeepData) {
    for (const char flag : {'\x08', '\x10'}) {
        std::string exr = encode_picture<float>("openexr", 1, 1, 3, {1, 2, 3});
        exr[5] = static_cast<char>(exr[5] | flag);
        EXPECT_THAT(read_refusal(exr), HasSubstr("deep data or several parts"));
    }
}

class AssetFiles : public ::testing::Test {
  protected:
    test::TemporaryFolder m_folder;
    const std::string m_png = encode_picture<std::uint8_t>("png", 3, 2, 4, noise(3 * 2 * 4));
};

TEST_F(AssetFiles, AreCheckedByTheirDeclaredType) {
    const auto png = m_folder.file("a", m_png);
    EXPECT_EQ(check_asset(png, "image/png"),
              (json{{"width", 3}, {"height", 2}, {"channels", 4}, {"notes", json::array()}}));
    EXPECT_THAT(refusal([&] { check_asset(png, "image/jpeg"); }), HasSubstr("is a PNG, not a JPEG"));
    EXPECT_THAT(refusal([&] { check_asset(png, "image/gif"); }), HasSubstr("image/gif are not accepted"));
    EXPECT_THAT(refusal([&] { check_asset(m_folder.file("empty", ""), "image/png"); }), HasSubstr("empty"));
    EXPECT_THAT(refusal([&] { check_asset(m_folder.path() / "none", "image/png"); }), HasSubstr("cannot be read"));
    const auto exr = m_folder.file("b", encode_picture<float>("openexr", 1, 1, 1, {1}));
    EXPECT_EQ(check_asset(exr, "image/x-exr")["channels"], 1);
}

TEST(AssetKinds, HaveEverythingThatAFormNeeds) {
    for (const AssetKind& kind : asset_kinds()) {
        EXPECT_EQ(find_asset_kind(kind.media_type), &kind);
        EXPECT_THAT(kind.type, AnyOf("texture", "model", "volume"));
        EXPECT_FALSE(kind.suffixes.empty()) << kind.media_type;
        for (const std::string& suffix : kind.suffixes) EXPECT_TRUE(suffix.starts_with('.')) << suffix;
    }
}

TEST_F(AssetFiles, AreFoundByTheirNames) {
    m_folder.file("leaf.png", m_png);
    FileAssets assets = assets_in_folder(m_folder.path());
    const Picture picture = assets.picture("leaf.png", 3, 2);
    EXPECT_EQ(picture.image.width_px, 3);
    EXPECT_EQ(picture.image.height_px, 2);
    EXPECT_EQ(assets.picture((m_folder.path() / "leaf.png").string(), 3, 2).image.rgba, picture.image.rgba);
    EXPECT_THAT(refusal([&] { assets.picture("no.png", 3, 2); }),
                AllOf(HasSubstr("\"no.png\""), HasSubstr((m_folder.path() / "no.png").string())));
    EXPECT_THAT(refusal([&] { assets.picture(".", 3, 2); }), HasSubstr("\".\""));
}

TEST_F(AssetFiles, AreKnownByTheirHashesOnceTheyAreRead) {
    std::filesystem::create_directories(m_folder.path() / "models/parts");
    const std::string triangle(36, '\0');
    m_folder.file("models/parts/my data.bin", triangle);
    const json document = {
        {"asset", {{"version", "2.0"}}},
        {"scene", 0},
        {"scenes", {{{"nodes", {0}}}}},
        {"nodes", {{{"mesh", 0}}}},
        {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}}},
        {"accessors", {{{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}}}},
        {"bufferViews", {{{"buffer", 0}, {"byteLength", 36}}}},
        {"buffers", {{{"byteLength", 36}, {"uri", "parts/my%20data.bin"}}}}};
    m_folder.file("models/one.gltf", document.dump());
    m_folder.file("leaf.png", m_png);
    FileAssets assets = assets_in_folder(m_folder.path());
    EXPECT_TRUE(assets.files().empty());
    assets.model("models/one.gltf");
    assets.picture("leaf.png", 2, 2);
    assets.picture("leaf.png", 4, 4);
    // The hash of 36 zero bytes comes from coreutils' sha256sum.
    const std::string zeros = "6db65fd59fd356f6729140571b5bcd6bb3b83492a16e1bf0a3884442fc3c8a0e";
    const std::vector<AssetFile> expected = {
        {"models/one.gltf", "", sha256_hex(document.dump()), document.dump().size()},
        {"models/parts/my data.bin", "models/one.gltf", zeros, 36},
        {"leaf.png", "", sha256_hex(m_png), m_png.size()}};
    EXPECT_EQ(assets.files(), expected);

    m_folder.file("leaf.png", encode_picture<std::uint8_t>("png", 1, 1, 1, {7}));
    assets.picture("leaf.png", 2, 2);
    ASSERT_EQ(assets.files().size(), 3u) << "as they were last read";
    EXPECT_NE(assets.files()[2].sha256, expected[2].sha256);
}

TEST_F(AssetFiles, OfADetachedVolumeAreInItsFolder) {
    std::filesystem::create_directory(m_folder.path() / "scan");
    const auto header = [&](const std::string& data_file) {
        m_folder.file(
            "scan/head.nhdr",
            "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 1 2 1\nencoding: raw\ndata file: " + data_file + "\n");
    };
    m_folder.file("scan/head.raw", "xy");
    m_folder.file("other.raw", "xy");
    FileAssets assets = assets_in_folder(m_folder.path());
    header("head.raw");
    EXPECT_EQ(assets.volume("scan/head.nhdr", {}).bytes, (std::vector<std::uint8_t>{'x', 'y'}));
    ASSERT_EQ(assets.files().size(), 2u);
    EXPECT_EQ(assets.files()[0].name, "scan/head.nhdr");
    EXPECT_EQ(assets.files()[1].name, "scan/head.raw");
    EXPECT_EQ(assets.files()[1].of, "scan/head.nhdr");
    header("../other.raw");
    EXPECT_THAT(refusal([&] { assets.volume("scan/head.nhdr", {}); }), HasSubstr("not in its folder"));
    header("none.raw");
    EXPECT_THAT(refusal([&] { assets.volume("scan/head.nhdr", {}); }),
                testing::AllOf(HasSubstr("keeps its data in another file"), HasSubstr("none.raw")));
    FileAssets uploads([&](const std::string& name) { return m_folder.path() / name; });
    header("head.raw");
    EXPECT_THAT(refusal([&] { uploads.volume("scan/head.nhdr", {}); }), HasSubstr("upload one with the data attached"));
}

}  // namespace
}  // namespace sheer::assets_test
